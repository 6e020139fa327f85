"""A small batch while processes are killed. `python -m tests.faults.batches` runs one of 500 meshes."""

from pathlib import Path

from tests.faults.batches import BatchCampaign, run_batch
from tests.faults.test_faults import FAST


def test_each_mesh_of_a_batch_has_one_result_whatever_is_killed(tmp_path: Path) -> None:
    outcome = run_batch(BatchCampaign(12, settings={**FAST, "QUADPATCH_LEASE_S": "10"}), tmp_path)
    assert outcome.faults == []
    assert sum(outcome.counts.values()) == 12
    assert outcome.kills == {"api": 1, "worker": 1, "dispatcher": 1}
