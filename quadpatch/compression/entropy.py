"""Whole numbers as bits; the one place that talks to `constriction`.

Numbers come in streams of one kind each. Three bytes describe a stream: how many low bits of a number are written as
they are, how often the rest is zero, and by which factor larger values get rarer (a geometric distribution). A sign
costs one bit. All streams share one coder (asymmetric numeral systems), so that none of them is padded.

The probabilities are products and quotients of small whole numbers, which IEEE arithmetic rounds in one way: a file
reads the same on every machine.

References
----------
J. Duda, K. Tahboub, N. J. Gadgil, E. J. Delp, "The use of asymmetric numeral systems as an accurate replacement for
Huffman coding", Picture Coding Symposium, 2015. R. Bamler, "Understanding entropy coding with asymmetric numeral
systems (ANS): a statistician's perspective", 2022 (constriction).
"""

from dataclasses import dataclass, field
from typing import Any

import constriction
import numpy as np

from quadpatch.errors import ReadError
from quadpatch.types import FloatArray, IntArray

# Magnitudes from here on are written as this one, and the excess apart.
_LARGEST = 40
# Values of the two parameters of a stream.
_LEVELS = 64
# Numbers have at most so many bits besides their sign.
MAX_BITS = 40
# Raw bits are written in pieces of so many.
_CHUNK = 12
# No symbol costs less: the most probable zero has the probability 63.75 / 64.
LEAST_BITS_A_SYMBOL = 0.005
_WORD = np.dtype("<u4")
_model = constriction.stream.model


@dataclass
class IntWriter:
    """Collects streams, and codes them in one piece."""

    _symbols: list[tuple[IntArray, Any]] = field(default_factory=list)
    _models: bytearray = field(default_factory=bytearray)

    def write(self, values: IntArray, *, signed: bool = True) -> None:
        """Append a stream of whole numbers below 2**40 in size; not below 0 where it isn't signed."""
        flat = np.asarray(values, np.int64).ravel()
        if not len(flat):
            return
        magnitude = np.abs(flat)
        if int(magnitude.max()) >> MAX_BITS:
            raise ValueError("a number is too large to be coded")
        shift, zero, rate = _best_model(magnitude)
        self._models += bytes([shift, zero, rate])
        high = magnitude >> shift
        self._symbols.append((np.minimum(high, _LARGEST), _geometric(zero, rate)))
        excess = high[high >= _LARGEST] - _LARGEST
        if len(excess):
            n_bits = int(excess.max()).bit_length()
            self._models.append(n_bits)
            self._write_bits(excess, n_bits)
        self._write_bits(magnitude & ((1 << shift) - 1), shift)
        if signed:
            self._write_bits((flat[magnitude > 0] < 0).astype(np.int64), 1)

    def _write_bits(self, values: IntArray, n_bits: int) -> None:
        for start in range(0, n_bits, _CHUNK):
            width = min(_CHUNK, n_bits - start)
            self._symbols.append(((values >> start) & ((1 << width) - 1), _model.Uniform(1 << width)))

    def finish(self) -> tuple[bytes, bytes]:
        """Return what describes the streams, and the coded numbers."""
        coder = constriction.stream.stack.AnsCoder()
        # What is written last is read first.
        for symbols, model in reversed(self._symbols):
            if len(symbols):
                coder.encode_reverse(symbols.astype(np.int32), model)
        return bytes(self._models), coder.get_compressed().astype(_WORD).tobytes()


class IntReader:
    """Reads the streams of an `IntWriter`, in the same order.

    Parameters
    ----------
    models, coded : bytes
        What `IntWriter.finish` returned; damaged bytes give other numbers or a ReadError, never more than were asked
        for.

    Raises
    ------
    ReadError
        If the coded bytes can't be those of a writer.
    """

    def __init__(self, models: bytes, coded: bytes) -> None:
        if len(coded) % _WORD.itemsize or coded.endswith(bytes(_WORD.itemsize)):
            raise ReadError("the coded numbers are damaged")
        self._models = models
        self._next = 0
        self._n_left = int((len(coded) * 8 + 64) / LEAST_BITS_A_SYMBOL)
        self._coder = constriction.stream.stack.AnsCoder(np.frombuffer(coded, _WORD).astype(np.uint32))

    def read(self, count: int, *, signed: bool = True) -> IntArray:
        """Read the next stream of so many numbers.

        Raises
        ------
        ReadError
            If so many numbers can't stand in so few bytes, before any memory is taken for them; or if what describes
            the stream is damaged.
        """
        if count == 0:
            return np.zeros(0, np.int64)
        shift, zero, rate = self._parameters(3, (MAX_BITS, _LEVELS - 1, _LEVELS - 1))
        high = self._decode(_geometric(zero, rate), count)
        is_large = np.flatnonzero(high == _LARGEST)
        if len(is_large):
            (n_bits,) = self._parameters(1, (MAX_BITS - shift,))
            high[is_large] += self._read_bits(len(is_large), n_bits)
        values = (high << shift) + self._read_bits(count, shift)
        if signed:
            nonzero = np.flatnonzero(values)
            values[nonzero] *= 1 - 2 * self._read_bits(len(nonzero), 1)
        return values

    def close(self) -> None:
        """Raise ReadError where numbers are left over, which no reader of the same format leaves."""
        if self._next != len(self._models) or not self._coder.is_empty():
            raise ReadError("the coded numbers do not end where they should")

    def _parameters(self, count: int, limits: tuple[int, ...]) -> tuple[int, ...]:
        found = tuple(self._models[self._next : self._next + count])
        self._next += count
        if len(found) < count or any(value > limit for value, limit in zip(found, limits, strict=True)):
            raise ReadError("the description of a stream is damaged")
        return found

    def _read_bits(self, count: int, n_bits: int) -> IntArray:
        values = np.zeros(count, np.int64)
        for start in range(0, n_bits, _CHUNK):
            values |= self._decode(_model.Uniform(1 << min(_CHUNK, n_bits - start)), count) << start
        return values

    def _decode(self, model: Any, count: int) -> IntArray:
        self._n_left -= count
        if self._n_left < 0:
            raise ReadError("the file claims more numbers than its bytes can hold")
        if count == 0:
            return np.zeros(0, np.int64)
        return np.asarray(self._coder.decode(model, count)).astype(np.int64)


def _best_model(magnitude: IntArray) -> tuple[int, int, int]:
    """Shift and levels of the two parameters that take the fewest bits."""
    costs = []
    for shift in range(int(magnitude.max()).bit_length() + 1):
        high = magnitude >> shift
        zero, rate = _fitted(high)
        large = high[high >= _LARGEST]
        excess = len(large) * int(large.max() - _LARGEST).bit_length() if len(large) else 0
        counts = np.bincount(np.minimum(high, _LARGEST), minlength=_LARGEST + 1)
        bits = -float(counts @ np.log2(_probabilities(zero, rate)))
        costs.append((bits + shift * len(high) + excess, shift, zero, rate))
    return min(costs)[1:]


def _fitted(high: IntArray) -> tuple[int, int]:
    nonzero = high[high > 0]
    zero = round(_LEVELS * (1.0 - len(nonzero) / len(high)) - 0.25)
    # A geometric distribution from 1 on with the mean m gets rarer by 1 - 1 / m.
    rate = round(_LEVELS * (1.0 - 1.0 / float(nonzero.mean())) - 0.25) if len(nonzero) else 0
    return min(max(zero, 0), _LEVELS - 1), min(max(rate, 0), _LEVELS - 1)


def _probabilities(zero: int, rate: int) -> FloatArray:
    """Probability of 0 .. _LARGEST, the last standing for all from there on; each exact or rounded once a step."""
    p_zero, factor = (4 * zero + 1) / (4 * _LEVELS), (4 * rate + 1) / (4 * _LEVELS)
    table = [p_zero]
    tail = 1.0 - p_zero
    for _ in range(_LARGEST - 1):
        table.append(tail * (1.0 - factor))
        tail *= factor
    # Nothing may be impossible, however steep the distribution.
    return np.asarray(np.maximum(np.array([*table, tail]), 1e-7))


def _geometric(zero: int, rate: int) -> Any:
    return _model.Categorical(_probabilities(zero, rate), perfect=False)
