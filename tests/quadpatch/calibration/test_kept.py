import json
import logging
from dataclasses import replace

import numpy as np
import pytest

from quadpatch.calibration.kept import KeptCalibrations, array_digest, key_of
from quadpatch.recipes.fairing_energies import FAIRING_ENERGIES
from quadpatch_rules.calibration_records import MOST_BYTES, MOST_RECORDS, RecordError
from tests.quadpatch.calibration.test_record import RECORD


def test_what_was_added_is_found_under_its_key_alone_and_after_it_was_written() -> None:
    kept = KeptCalibrations()
    kept.add(key_of("scan", 0.1), RECORD)
    assert kept.has_new
    again = KeptCalibrations.read(kept.written(), FAIRING_ENERGIES)
    assert not again.has_new
    found = again.find(key_of("scan", 0.1))
    assert found is not None
    assert found.plain() == RECORD.plain()
    assert again.find(key_of("scan", np.nextafter(0.1, 1).item())) is None
    assert again.find(key_of("another scan", 0.1)) is None


def test_the_oldest_of_too_many_are_dropped_and_all_of_them_fit_into_the_limit() -> None:
    kept, keys = KeptCalibrations(), [key_of(i) for i in range(MOST_RECORDS + 2)]
    for key in keys:
        kept.add(key, RECORD)
    kept.add(keys[2], replace(RECORD, seconds=2.0))
    again = KeptCalibrations.read(kept.written(), FAIRING_ENERGIES)
    assert [again.find(key) is not None for key in keys] == [False] * 2 + [True] * MOST_RECORDS
    assert list(json.loads(kept.written())["records"])[-1] == keys[2]
    assert len(kept.written()) < MOST_BYTES


def test_a_record_that_could_not_be_read_again_is_not_kept(caplog: pytest.LogCaptureFixture) -> None:
    kept = KeptCalibrations()
    with caplog.at_level(logging.WARNING):
        kept.add(key_of(), replace(RECORD, error_model=replace(RECORD.error_model, factor=np.inf)))
    assert (kept.has_new, kept.find(key_of())) == (False, None)
    assert "a calibration is not kept" in caplog.text


def test_a_damaged_record_is_left_out_with_a_line_in_the_log(caplog: pytest.LogCaptureFixture) -> None:
    kept = KeptCalibrations()
    kept.add(key_of(1), RECORD)
    kept.add(key_of(2), replace(RECORD, seconds=3.5))
    damaged = kept.written().replace(b'"seconds": 3.5', b'"seconds": "soon"')
    with caplog.at_level(logging.WARNING):
        again = KeptCalibrations.read(damaged, FAIRING_ENERGIES)
    assert [again.find(key_of(i)) is not None for i in (1, 2)] == [True, False]
    assert "a kept calibration is left out" in caplog.text


def test_energies_that_calibration_does_not_choose_are_not_taken() -> None:
    kept = KeptCalibrations()
    kept.add(key_of(), RECORD)
    assert KeptCalibrations.read(kept.written(), FAIRING_ENERGIES[:-1]).find(key_of()) is None


def test_other_files_are_refused() -> None:
    with pytest.raises(RecordError):
        KeptCalibrations.read(b"solid scan", FAIRING_ENERGIES)


def test_a_digest_knows_values_types_shapes_and_order() -> None:
    numbers, table = np.arange(6.0), np.arange(6.0).reshape(2, 3)
    digests = {array_digest(numbers), array_digest(table), array_digest(table.reshape(3, 2)), array_digest(-numbers)}
    assert len(digests | {array_digest(np.arange(6)), array_digest(numbers, numbers), array_digest()}) == 7
    assert array_digest(table.T) == array_digest(table.T.copy())
