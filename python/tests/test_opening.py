"""Models from files, bytes and sources; processes and signals."""

import _thread
import multiprocessing
import pathlib
import pickle
import signal
import sys
import threading
import time

import numpy as np
import pytest

import welkin_sky
from conftest import MODEL_FILE, SCENE

UP = np.float32([0.0, 0.0, 1.0])


def test_all_ways_give_the_same(sky):
    data = MODEL_FILE.read_bytes()
    expected = sky.radiance(UP)
    for model in (
        welkin_sky.open(MODEL_FILE),
        welkin_sky.open(str(MODEL_FILE), in_memory=True),
        welkin_sky.from_bytes(data),
        welkin_sky.from_bytes(memoryview(bytearray(data))),
        welkin_sky.stream(lambda offset, length: data[offset : offset + length]),
    ):
        model.verify()
        assert model.file_bytes == len(data)
        assert np.array_equal(model.sky(**SCENE).radiance(UP), expected)
        assert np.allclose(model.radiance(UP, **SCENE), expected, rtol=1e-4)


class Remote:
    """A source with a method, as an object store has."""

    def __init__(self):
        self.file = MODEL_FILE.open("rb")
        self.lock = threading.Lock()

    def read_at(self, offset, length):
        with self.lock:
            self.file.seek(offset)
            return self.file.read(length)


def test_a_stream_reads_what_a_scene_needs():
    model = welkin_sky.stream(Remote())
    assert model.traffic[0] <= 2
    model.sky(**SCENE)
    requests, read = model.traffic
    assert model.touched_bytes <= read < model.file_bytes / 3 and requests < 20
    plan = model.plan(altitude=(0.0, 1000.0), visibility=(40e3, 60e3), channels="colour")
    assert 0 < plan.file_bytes < model.file_bytes and plan.chunk_count > 1
    model.load(plan)
    before = model.traffic
    model.colour_sky(altitude=500.0, visibility=50e3, solar_elevation=0.1).bake()
    assert model.traffic == before
    with pytest.raises(TypeError):
        pickle.dumps(model)


def test_a_stream_serves_many_threads(sky):
    data = MODEL_FILE.read_bytes()
    model = welkin_sky.stream(lambda offset, length: data[offset : offset + length])
    answers = [None] * 8

    def ask(i):
        answers[i] = model.sky(**{**SCENE, "altitude": 100.0 * i}).radiance(UP)

    threads = [threading.Thread(target=ask, args=(i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
        assert not thread.is_alive()
    assert all(answer is not None for answer in answers)


def test_what_a_source_raises_is_the_cause():
    def fail(offset, length):
        raise ConnectionError("gone")

    with pytest.raises(welkin_sky.IoError) as refused:
        welkin_sky.stream(fail)
    assert isinstance(refused.value, OSError) and refused.value.offset == 0
    assert isinstance(refused.value.__cause__, ConnectionError)
    for answer in (b"x" * 100_000, "text", 3, None):
        with pytest.raises(welkin_sky.WelkinError):
            welkin_sky.stream(lambda offset, length: answer)
    for source in (3, None, "path"):
        with pytest.raises(TypeError):
            welkin_sky.stream(source)


def test_files_that_are_none(tmp_path):
    with pytest.raises(welkin_sky.FileMissingError) as missing:
        welkin_sky.open(tmp_path / "none.welkin")
    assert isinstance(missing.value, FileNotFoundError)
    assert missing.value.filename == str(tmp_path / "none.welkin") and missing.value.errno == 2
    with pytest.raises(welkin_sky.IoError):
        welkin_sky.open(tmp_path)
    data = bytearray(MODEL_FILE.read_bytes())
    for damaged, kind in (
        (b"", welkin_sky.MagicError),
        (b"no welkin file at all" * 100, welkin_sky.MagicError),
        (bytes(data[:100]), welkin_sky.LengthError),
        (bytes(data[:-1]), welkin_sky.LengthError),
    ):
        with pytest.raises(kind):
            welkin_sky.from_bytes(damaged)
        path = tmp_path / "damaged.welkin"
        path.write_bytes(damaged)
        with pytest.raises(kind):
            welkin_sky.open(path)
    data[len(data) // 2] ^= 1
    with pytest.raises(welkin_sky.ChecksumError):
        welkin_sky.from_bytes(data).verify()
    for no_bytes in (3, "text", None):
        with pytest.raises(TypeError):
            welkin_sky.from_bytes(no_bytes)


def test_models_conditions_and_errors_are_pickled(model, sky):
    moon = welkin_sky.Moon(phase_angle=0.5)
    for one in (model, welkin_sky.open(MODEL_FILE), welkin_sky.from_bytes(MODEL_FILE.read_bytes())):
        again = pickle.loads(pickle.dumps(one))
        assert np.array_equal(again.sky(**SCENE).radiance(UP), sky.radiance(UP))
    moonlit = pickle.loads(pickle.dumps(model.moonlit(moon)))
    assert moonlit.is_moonlit and not model.is_moonlit
    expected = model.moonlit(moon).sky(**SCENE).radiance(UP)
    assert np.array_equal(moonlit.sky(**SCENE).radiance(UP), expected)
    for value in (welkin_sky.Conditions(**SCENE), moon):
        assert pickle.loads(pickle.dumps(value)) == value
    with pytest.raises(welkin_sky.RangeError) as refused:
        model.sky(visibility=3.0)
    again = pickle.loads(pickle.dumps(refused.value))
    assert type(again) is welkin_sky.RangeError and again.min == refused.value.min
    assert str(again) == str(refused.value)


def _ask(model):
    directions = np.random.default_rng(1).normal(size=(20000, 3))
    return float(model.sky(**SCENE).radiance(directions, threads=2).sum())


@pytest.mark.skipif(not hasattr(sys.modules["os"], "fork"), reason="no fork")
def test_threads_work_after_a_fork(model):
    expected = _ask(model)
    context = multiprocessing.get_context("fork")
    with context.Pool(2) as pool:
        assert pool.map_async(_ask, [model] * 4).get(60) == [expected] * 4


def test_long_calls_can_be_interrupted(model):
    # Where tests run in the background, SIGINT is ignored.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    directions = np.random.default_rng(1).normal(size=(2_000_000, 3)).astype(np.float32)
    threading.Timer(0.1, _thread.interrupt_main).start()
    with pytest.raises(KeyboardInterrupt):
        # The timer may be late on a crowded machine.
        for _ in range(20):
            start = time.perf_counter()
            model.radiance(directions, solar_elevation=0.3, threads=1)
    assert time.perf_counter() - start < 3.0


def test_other_threads_go_on_meanwhile(model):
    """The interpreter's lock is not held: another thread counts while one call runs."""
    directions = np.random.default_rng(1).normal(size=(200_000, 3)).astype(np.float32)
    model.radiance(directions[:1])
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    before = counted[0]
    model.radiance(directions, threads=1)
    during = counted[0] - before
    done.set()
    thread.join()
    assert during > 20
    assert pathlib.Path(welkin_sky.__file__).with_name("py.typed").exists()
