"""kconfig.py PROJECT: what zephyr/Kconfig and lib/Kconfig offer, read by Kconfiglib, on which Zephyr's and
ESP-IDF's own readers are built."""

import pathlib
import re
import sys

import kconfiglib

project = pathlib.Path(sys.argv[1])
config_h = (project / "lib/include/grrl/base/config.h").read_text()


def load(path):
    kconfig = kconfiglib.Kconfig(str(project / path), warn=True, warn_to_stderr=False)
    assert not kconfig.warnings, kconfig.warnings
    return kconfig


zephyr = load("zephyr/Kconfig")
assert zephyr.syms["GRRL"].str_value == "n", "the module must be off unless asked for"
assert zephyr.syms["GRRL_PROFILE_SMALL"].visibility == 0, "its options must be hidden while it is off"
zephyr.syms["GRRL"].set_value("y")

for kconfig in (zephyr, load("lib/Kconfig")):
    profiles = [symbol.name for symbol in kconfig.named_choices["GRRL_PROFILE"].syms]
    known = re.findall(r"#define GRRL_PROFILE_IS_(\w+)", config_h)
    assert profiles == ["GRRL_PROFILE_" + name.upper() for name in known], profiles
    assert kconfig.syms["GRRL_PROFILE_SMALL"].str_value == "y"
    kconfig.syms["GRRL_PROFILE_TINY"].set_value("y")
    assert kconfig.syms["GRRL_PROFILE_SMALL"].str_value == "n", "one profile at a time"
    for name in ("LINKS", "FEATURES", "KEYFRAMES"):
        symbol = kconfig.syms["GRRL_MAX_" + name]
        most = re.search(r"GRRL_MAX_" + name + r" <= (\d+)", config_h)[1]
        assert symbol.str_value == "0", f"{name} must be left to the profile"
        symbol.set_value(most)
        assert symbol.str_value == most, f"{name}: config.h allows {most}"
        symbol.set_value(str(int(most) + 1))
        assert symbol.str_value != str(int(most) + 1), f"{name}: config.h allows {most} and no more"
