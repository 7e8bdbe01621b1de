"""Images of the scene for spot checks; the run does not depend on them."""

import os
import struct
import sys
import zlib


def write_png(path, image):
    """An RGB image (rows x columns x 3, uint8) as a PNG file."""
    height, width, _ = image.shape
    rows = b"".join(b"\0" + row.tobytes() for row in image)

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
                   + chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b""))


class Pictures:
    """One image per rest, DIR/trial-TTT-push-PPP.png. Construct it before MuJoCo draws."""

    WIDTH, HEIGHT = 960, 720

    def __init__(self, directory):
        if sys.platform == "linux" and not os.environ.get("DISPLAY"):
            os.environ.setdefault("MUJOCO_GL", "egl")
        os.makedirs(directory, exist_ok=True)
        self.directory = directory
        self.model = self.renderer = None
        self._try_out()

    def _try_out(self):
        """Raises RuntimeError if this machine cannot draw; better now than at the first rest."""
        try:
            import mujoco  # reads MUJOCO_GL when it is imported

            empty = mujoco.MjModel.from_xml_string("<mujoco/>")
            mujoco.Renderer(empty, 8, 8).close()
        except Exception as error:  # what fails, and how, differs with MUJOCO_GL and the driver
            raise RuntimeError(
                f"--render: OpenGL does not start ({error}); install EGL (Debian: libegl1) and set "
                "MUJOCO_GL=egl, or leave --render out") from None

    def take(self, trial_id, pushes, world):
        import mujoco

        if self.model is not world.model:
            if self.renderer is not None:
                self.renderer.close()
            self.model = world.model
            self.renderer = mujoco.Renderer(self.model, self.HEIGHT, self.WIDTH)
        self.renderer.update_scene(world.data, camera="above")
        name = f"trial-{trial_id:03d}-push-{pushes:03d}.png"
        write_png(os.path.join(self.directory, name), self.renderer.render())
