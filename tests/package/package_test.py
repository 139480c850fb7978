#!/usr/bin/env python3
"""Makes the Debian package and looks into it. Usage: package_test.py BUILD_FOLDER CPACK.
Exit code 77: a tool is missing."""
import configparser
import os
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

SKIPPED = 77
EXPECTED = ["bin/icloth", "bin/icloth-bench", "share/applications/icloth.desktop",
            "share/icons/hicolor/scalable/apps/icloth.svg", "share/mime/packages/icloth.xml",
            "share/doc/icloth/copyright", "share/icloth/scenes/scarf.json",
            "share/icloth/bodies/bust.obj"]


def run(*words):
    done = subprocess.run(words, text=True, capture_output=True, check=False)
    assert done.returncode == 0, f"{words}: {done.stdout}{done.stderr}"
    return done.stdout


def main():
    build, cpack = sys.argv[1:3]
    for tool in ("dpkg-deb", "dpkg-shlibdeps"):
        if not shutil.which(tool):
            print(f"skipped: {tool} is not installed")
            sys.exit(SKIPPED)
    folder = tempfile.mkdtemp(prefix="icloth_package_")
    try:
        run(cpack, "-G", "DEB", "--config", os.path.join(build, "CPackConfig.cmake"), "-B", folder)
        packages = [f for f in os.listdir(folder) if f.endswith(".deb")]
        assert len(packages) == 1, packages
        package = os.path.join(folder, packages[0])
        root = os.path.join(folder, "root")
        run("dpkg-deb", "-x", package, root)
        for name in EXPECTED:
            assert os.path.exists(os.path.join(root, "usr", name)), f"{name} is missing"

        # The libraries that the program was linked with are asked for.
        depends = run("dpkg-deb", "-f", package, "Depends")
        for library in ("libtbb", "libglfw3", "libassimp", "libc6"):
            assert library in depends, depends

        # The program works from where it lies, with the assets of the package.
        program = os.path.join(root, "usr", "bin", "icloth")
        info = run(program, "info")
        assert os.path.join(root, "usr", "share", "icloth") in info, info
        run(program, "run", "scarf", "--set", "triangles=200", "--steps", "2", "--quiet")

        # The desktop opens scenes with it, by an ending of their own.
        share = os.path.join(root, "usr", "share")
        entry = configparser.ConfigParser(interpolation=None)
        entry.optionxform = str
        entry.read(os.path.join(share, "applications", "icloth.desktop"))
        desktop = entry["Desktop Entry"]
        kinds = ElementTree.parse(os.path.join(share, "mime", "packages", "icloth.xml")).getroot()
        space = {"m": "http://www.freedesktop.org/standards/shared-mime-info"}
        kind = kinds.find("m:mime-type", space)
        assert desktop["MimeType"] == kind.get("type") + ";", desktop["MimeType"]
        assert kind.find("m:glob", space).get("pattern") == "*.icloth"
        assert desktop["Exec"].split()[0] == "icloth" and desktop["Icon"] == "icloth"
        ElementTree.parse(os.path.join(share, "icons", "hicolor", "scalable", "apps", "icloth.svg"))
        print(f"{packages[0]}: {os.path.getsize(package) / 1e6:.1f} MB")
    finally:
        shutil.rmtree(folder)


if __name__ == "__main__":
    main()
