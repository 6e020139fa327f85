import numpy as np

from quadpatch.mesh.loops import by_length, cut_at, laid_out

LOOPS = [np.array(loop) for loop in ([4, 2, 9], [1, 3, 5, 7], [8, 6, 0])]


def test_loops_lie_end_to_end_and_close() -> None:
    starts, following = laid_out(LOOPS)
    assert starts.tolist() == [0, 3, 7, 10]
    assert following.tolist() == [1, 2, 0, 4, 5, 6, 3, 8, 9, 7]


def test_cutting_takes_apart_what_is_laid_out() -> None:
    starts, _ = laid_out(LOOPS)
    assert [loop.tolist() for loop in cut_at(np.concatenate(LOOPS), starts)] == [loop.tolist() for loop in LOOPS]


def test_loops_of_one_length_come_together() -> None:
    vertices = np.concatenate(LOOPS)
    found = [(members.tolist(), vertices[places].tolist()) for members, places in by_length(laid_out(LOOPS)[0])]
    assert found == [([0, 2], [[4, 2, 9], [8, 6, 0]]), ([1], [[1, 3, 5, 7]])]
    assert list(by_length(np.zeros(1, np.int64))) == []
