import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quadpatch.compression.entropy import MAX_BITS, IntReader, IntWriter
from quadpatch.errors import ReadError

numbers = st.integers(-(2**MAX_BITS) + 1, 2**MAX_BITS - 1)


@given(st.lists(st.lists(numbers, max_size=30), max_size=5))
def test_streams_come_back_as_they_were(streams: list[list[int]]) -> None:
    writer = IntWriter()
    for stream in streams:
        writer.write(np.array(stream, np.int64))
    reader = IntReader(*writer.finish())
    assert [reader.read(len(stream)).tolist() for stream in streams] == streams
    reader.close()


def test_a_sparse_stream_takes_little_more_than_its_entropy() -> None:
    rng = np.random.default_rng(0)
    values = np.where(rng.random(20_000) < 0.05, rng.choice([-1, 1], 20_000), 0)
    writer = IntWriter()
    writer.write(values)
    p = np.count_nonzero(values) / len(values)
    entropy = len(values) * (-p * np.log2(p / 2) - (1 - p) * np.log2(1 - p))
    assert sum(map(len, writer.finish())) < 1.05 * entropy / 8 + 8


def test_a_number_that_is_too_large_is_refused() -> None:
    with pytest.raises(ValueError, match="too large"):
        IntWriter().write(np.array([1 << MAX_BITS]))


def test_more_numbers_than_the_bytes_can_hold_are_refused_before_memory_is_taken() -> None:
    writer = IntWriter()
    writer.write(np.zeros(10, np.int64))
    with pytest.raises(ReadError, match="more numbers than its bytes"):
        IntReader(*writer.finish()).read(10**15)


def test_left_over_numbers_are_noticed() -> None:
    writer = IntWriter()
    writer.write(np.arange(100))
    reader = IntReader(*writer.finish())
    reader.read(50)
    with pytest.raises(ReadError, match="do not end"):
        reader.close()


def test_damaged_bytes_give_numbers_or_a_read_error() -> None:
    rng = np.random.default_rng(1)
    values = np.rint(rng.laplace(0, 20, 500)).astype(np.int64)
    writer = IntWriter()
    writer.write(values)
    models, coded = writer.finish()
    outcomes = set()
    for place in range(len(models) + len(coded)):
        damaged = bytearray(models + coded)
        damaged[place] ^= 1 << int(rng.integers(8))
        try:
            found = IntReader(bytes(damaged[: len(models)]), bytes(damaged[len(models) :])).read(500)
            outcomes.add(len(found))
        except ReadError:
            outcomes.add(-1)
    assert outcomes <= {500, -1}
    assert 500 in outcomes
