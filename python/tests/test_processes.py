"""Threads, processes, interpreters, signals."""

import concurrent.futures
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy
import pytest

import darkroot


def run(code, *arguments, **how):
    """Runs Python code in a process of its own."""
    command = [sys.executable, "-c", textwrap.dedent(code), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, **how)


def mean(path):
    return float(darkroot.develop(path, scale=1 / 8).mean())


def test_threads_develop_at_once_and_get_the_same(nef):
    expected = darkroot.develop(nef)
    photo = darkroot.open(nef)
    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        shared = [pool.submit(photo.develop) for _ in range(8)]
        own = [pool.submit(darkroot.develop, nef) for _ in range(8)]
        assert all(numpy.array_equal(one.result(), expected) for one in shared + own)


def test_the_lock_of_python_is_free_while_files_are_developed(nef):
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    counter = threading.Thread(target=count)
    counter.start()
    for _ in range(5):
        darkroot.develop(nef, denoise="1", sharpen="1")
    done.set()
    counter.join()
    assert counted[0] > 20


@pytest.mark.parametrize("method", ["fork", "spawn", "forkserver"])
def test_processes_of_every_kind_develop_after_their_parent_did(nef, method):
    expected = mean(nef)
    context = multiprocessing.get_context(method)
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:
        assert list(pool.map(mean, [nef] * 4, timeout=100)) == [expected] * 4


def test_a_photo_made_before_a_fork_is_whole_in_the_child(nef):
    photo = darkroot.open(nef)
    expected = photo.develop(scale=1 / 4).sum()
    child = os.fork()
    if child == 0:
        os._exit(0 if photo.develop(scale=1 / 4).sum() == expected else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def test_errors_go_to_other_processes(tmp_path):
    with pytest.raises(darkroot.MissingError) as raised:
        darkroot.open("nothing.nef")
    again = pickle.loads(pickle.dumps(raised.value))
    assert type(again) is darkroot.MissingError and str(again) == str(raised.value)
    with concurrent.futures.ProcessPoolExecutor(1) as pool:
        with pytest.raises(darkroot.MissingError, match="no such file"):
            pool.submit(mean, "nothing.nef").result(timeout=100)


SUB_INTERPRETER = """
    try:
        import _interpreters as interpreters
        number = interpreters.create("legacy")
        said = interpreters.exec(number, "import darkroot")
        print(said and said.msg)
    except ImportError:
        import _xxsubinterpreters as interpreters
        number = interpreters.create(isolated=False)
        try:
            interpreters.run_string(number, "import darkroot")
        except interpreters.RunFailedError as fault:
            print(fault)
"""


def test_sub_interpreters_are_refused_in_words():
    told = run(SUB_INTERPRETER)
    assert "darkroot works in the main interpreter only" in told.stdout, told


LONG = """
    import sys, darkroot
    print("begun", flush=True)
    try:
        {call}
    except KeyboardInterrupt:
        print("interrupted", flush=True)
"""


@pytest.mark.parametrize(
    "call",
    [
        "while True: darkroot.develop(sys.argv[1], denoise='1', sharpen='1')",
        "while True: darkroot.develop_file(sys.argv[1], sys.argv[2], overwrite=True, denoise='1')",
        "for one in darkroot.develop_many(sys.argv[1] for _ in range(10**6)): pass",
        "darkroot.batch([sys.argv[1]] , sys.argv[2] + '.out', workers='threads', redo=True); __import__('time').sleep(9)",
        "while True: darkroot.detect_charts(sys.argv[1])",
    ],
)
def test_ctrl_c_ends_a_long_call_within_a_second(nef, raw, tmp_path, call):
    path = raw("--format", "nef", "--width", "3000", "--height", "2000", name="large.nef")
    code = textwrap.dedent(LONG).format(call=call)
    process = subprocess.Popen(
        [sys.executable, "-c", code, path, tmp_path / "a.jpg"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout.readline() == "begun\n"
    time.sleep(0.7)
    begin = time.monotonic()
    process.send_signal(signal.SIGINT)
    assert process.stdout.readline() == "interrupted\n", process.stderr.read()
    # A second; where others keep every core busy, so long as the system needs to let us run.
    busy = os.getloadavg()[0] > (os.cpu_count() or 1)
    assert time.monotonic() - begin < (3.0 if busy else 1.0)
    assert process.wait(timeout=20) == 0, process.stderr.read()
    assert not [name for name in os.listdir(tmp_path) if name.startswith(".darkroot-")]


def test_what_is_not_raw_leaves_the_terminal_alone(nef):
    """Decoders that fail over damaged files write nothing to standard error."""
    code = """
        import sys, darkroot
        data = open(sys.argv[1], "rb").read()
        for cut in range(100, len(data), len(data) // 40):
            try:
                darkroot.open(data[:cut])
            except darkroot.FileError:
                pass
    """
    told = run(code, nef)
    assert (told.returncode, told.stderr) == (0, "")


def test_many_opens_leak_nothing(nef):
    """Memory after 200 more opens is what it was after the first ones."""
    code = """
        import sys, darkroot
        def resident():
            return int(open("/proc/self/statm").read().split()[1]) * 4096
        def some(count):
            for _ in range(count):
                with darkroot.open(sys.argv[1]) as photo:
                    photo.develop(scale=1/16, profile="matrix"); photo.mosaic
                try: darkroot.open(b"II*\\0" + bytes(50))
                except darkroot.FileError: pass
        some(50)
        before = resident()
        some(200)
        print(resident() - before)
    """
    if not os.path.exists("/proc/self/statm"):
        pytest.skip("the system does not tell how much memory a process has")
    told = run(code, nef)
    assert told.returncode == 0, told.stderr
    # A frame has 0.7 megabytes: one lost in fifty would be seen.
    assert int(told.stdout) < 3_000_000
