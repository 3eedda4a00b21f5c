"""Time and memory beside rawpy: `python beside_rawpy.py MAKE_RAW [DECODE_TIME]`. Figures stand in docs/python.md.

A NEF and a DNG of 24 megapixels are simulated by MAKE_RAW (`cargo build --release -p darkroot-simulate --example make_raw`). Each
measurement is a process of its own, the two libraries in turn. DECODE_TIME (`cargo build --release -p darkroot-raw --example
decode_time`) says what the decoder takes alone.
"""

import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

#: Pairs of runs.
RUNS = 5

OPEN_TO_LINEAR = {
    "darkroot": "import darkroot; work = lambda: darkroot.develop(path, look='linear', dtype='uint16')",
    "darkroot, matrix": "import darkroot; work = lambda: darkroot.develop(path, look='linear', dtype='uint16', profile='matrix')",
    "darkroot, float32": "import darkroot; work = lambda: darkroot.develop(path, look='linear')",
    "rawpy, AHD": """
import rawpy
def work():
    with rawpy.imread(path) as raw:
        return raw.postprocess(
            demosaic_algorithm=rawpy.DemosaicAlgorithm.AHD, gamma=(1, 1), no_auto_bright=True, output_bps=16, use_camera_wb=True
        )
""",
}

MEASURE = """
import json, resource, sys, time
path = sys.argv[1]
{work}
def cpu():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime
before, begin = cpu(), time.perf_counter()
shape = work().shape
seconds, used = time.perf_counter() - begin, cpu() - before
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
print(json.dumps({{"wall": seconds, "cpu": used, "peak": peak, "shape": shape}}))
"""

MOSAIC = """
import json, sys, time, darkroot
data = open(sys.argv[1], "rb").read()
times = []
for _ in range(7):
    begin = time.perf_counter()
    darkroot.open(data).mosaic
    times.append(time.perf_counter() - begin)
print(json.dumps(sorted(times)[3]))
"""

OPENS = """
import sys, darkroot
def resident():
    return int(open("/proc/self/statm").read().split()[1]) * 4096 / 2**20
data = open(sys.argv[1], "rb").read()
def some(count):
    for _ in range(count):
        with darkroot.open(data) as photo:
            photo.mosaic
            photo.develop(scale=1/16)
some(100)
before = resident()
some(1000)
print(f"{before:.1f} MiB after 100 opens, {resident():.1f} MiB after 1,000 more")
"""


def python(code, *arguments):
    """What a process of its own prints."""
    return subprocess.run(
        [sys.executable, "-c", code, *map(str, arguments)], capture_output=True, text=True, check=True
    ).stdout


def main():
    """Prints the figures."""
    make_raw, decode_time = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else None
    with tempfile.TemporaryDirectory() as folder:
        for kind in ("nef", "dng"):
            path = pathlib.Path(folder, f"a.{kind}")
            command = [make_raw, "--format", kind, "--width", "6000", "--height", "4000", "--out", path]
            subprocess.run(command, check=True, capture_output=True)
            found = {name: [] for name in OPEN_TO_LINEAR}
            for _ in range(RUNS):
                for name, work in OPEN_TO_LINEAR.items():
                    found[name].append(json.loads(python(MEASURE.format(work=work), path)))
            print(f"{kind}, 24 MP, open to linear RGB, medians of {RUNS}:")
            for name, runs in found.items():
                middle = {key: statistics.median(run[key] for run in runs) for key in ("wall", "cpu", "peak")}
                ratio = {
                    key: statistics.median(other[key] / run[key] for other, run in zip(found["rawpy, AHD"], runs))
                    for key in ("wall", "cpu")
                }
                print(
                    f"  {name:18} wall {middle['wall']:.2f} s, CPU {middle['cpu']:.2f} s, peak {middle['peak']:.0f} MiB; "
                    f"rawpy takes {ratio['wall']:.2f} x as long, and this {1 / ratio['cpu']:.2f} x its CPU"
                )
            print(f"  .mosaic from bytes: {1000 * json.loads(python(MOSAIC, path)):.0f} ms", end="")
            if decode_time:
                alone = subprocess.run([decode_time, path], capture_output=True, text=True, check=True).stdout
                print(f"; the decoder alone: {alone.strip()}", end="")
            print()
        path = pathlib.Path(folder, "small.nef")
        command = [make_raw, "--format", "nef", "--width", "720", "--height", "480", "--out", path]
        subprocess.run(command, check=True, capture_output=True)
        print("  leaks:", python(OPENS, path).strip())


if __name__ == "__main__":
    main()
