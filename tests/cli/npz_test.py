# SPDX-License-Identifier: MIT
#
# npz_test.py PROGRAM: the file that the unit test of .npz files writes is a zip archive for Python's zipfile, with names, checksums and
# .npy headers as NumPy expects them.
import ast
import os
import struct
import subprocess
import sys
import tempfile
import zipfile


def load(content):
    """The type, the shape and the bytes of the elements of a .npy file (NumPy Enhancement Proposal 1)."""
    assert content[:6] == b"\x93NUMPY" and content[6] == 1, content[:8]
    end = 10 + struct.unpack("<H", content[8:10])[0]
    assert end % 64 == 0 and content[end - 1 : end] == b"\n", end
    header = ast.literal_eval(content[10:end].decode())
    assert header["fortran_order"] is False, header
    return header["descr"], header["shape"], content[end:]


for long in {}, {"SK_NPZ_LONG": "1"}:  # and with the numbers of 64 bits that only large files have
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "two.npz")
        subprocess.run([sys.argv[1], "[.npz_file]"], env={**os.environ, **long, "SK_NPZ_FILE": path}, check=True,
                       stdout=subprocess.DEVNULL)
        with zipfile.ZipFile(path) as file:
            assert file.testzip() is None
            arrays = {name: load(file.read(name)) for name in file.namelist()}
            assert all(entry.compress_type == zipfile.ZIP_STORED for entry in file.infolist())
            assert all(bool(entry.extra) == bool(long) for entry in file.infolist())
    assert set(arrays) == {"heat::diffuse/u.npy", "heat::diffuse/k.npy"}, arrays
    assert arrays["heat::diffuse/u.npy"] == ("<f4", (2, 3), struct.pack("<6f", 1, 2.5, -3, 4, 5, 6)), arrays
    assert arrays["heat::diffuse/k.npy"] == ("<i8", (), struct.pack("<q", -7)), arrays
