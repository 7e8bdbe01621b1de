"""Packs a folder as `pio pkg pack FOLDER -o FILE` does, with its check of the manifest. The one thing it
would fetch is the list of licences; the test brings the one in question."""

import sys

from platformio.package.manifest import schema
from platformio.package.pack import PackagePacker

schema.ManifestSchema.load_spdx_licenses = staticmethod(lambda: {"licenses": [{"licenseId": "MIT"}]})
PackagePacker(sys.argv[1]).pack(sys.argv[2])
