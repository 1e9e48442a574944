"""Opens the page of `microtrace view`, then ends the program.

Usage: python3 view.py PROGRAM SCENE
"""

import subprocess
import sys
import urllib.request

program, scene = sys.argv[1:]
process = subprocess.Popen([program, "view", scene, "--no-browser"], stdout=subprocess.PIPE, text=True)
try:
    address = process.stdout.readline().strip()
    with urllib.request.urlopen(address, timeout=60) as response:
        assert b"<title>" in response.read()
    urllib.request.urlopen(address + "end", data=b"", timeout=60).close()
    sys.exit(process.wait(timeout=60))
finally:
    process.kill()
