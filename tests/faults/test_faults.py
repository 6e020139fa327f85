"""A short campaign with a fixed seed. `make faults` runs the long one, with the leases of a deployment."""

import pytest

from tests.faults import faults
from tests.faults.campaign import Campaign, Outcome, run_campaign
from tests.faults.load import Workload
from tests.faults.table import to_text
from tests.faults.violations import consistency_violations

# Short leases, so that the loss of a worker shows within seconds.
FAST = {"QUADPATCH_HEARTBEAT_S": "0.5", "QUADPATCH_DISPATCH_S": "0.3", "QUADPATCH_LEADER_LEASE_S": "4"}
# Less than the three workers need at once: some jobs wait for memory when processes are killed.
SCARCE = {"QUADPATCH_MACHINE_MEMORY_MB": "360", "QUADPATCH_MEMORY_WAIT_S": "3"}
KILLS = (faults.kill_worker, faults.kill_engine, faults.kill_api, faults.kill_dispatcher)
OUTAGES = (faults.kill_valkey, faults.flush_valkey, faults.stop_database, faults.refuse_store, faults.freeze_worker)

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def outcome(tmp_path_factory: pytest.TempPathFactory) -> Outcome:
    campaign = Campaign(
        Workload(seed=5, n_jobs=25, n_stations=5, long_width=60),
        "sqlite-local",
        rounds=1,
        pause_s=(0.2, 1.0),
        settings={**FAST, **SCARCE},
        kills=KILLS,
        outages=OUTAGES,
        wants_namespaces=False,
        # Longer than the database is ever unavailable, even on a busy machine: no lease runs out for that.
        lease_s=10.0,
    )
    return run_campaign(campaign, tmp_path_factory.mktemp("faults"))


def test_every_accepted_job_ends_once_and_leaves_nothing_behind(outcome: Outcome) -> None:
    assert consistency_violations(outcome) == [], to_text(outcome)
    assert outcome.consistency.n_accepted >= 25


def test_every_fault_has_been_injected(outcome: Outcome) -> None:
    injected = {injection.fault for injection in outcome.injection_log.injections}
    expected = {
        "worker killed",
        "engine killed",
        "API killed",
        "leading dispatcher killed",
        "Valkey killed",
        "Valkey flushed",
        "database away",
        "store refuses",
        "worker frozen",
    }
    assert injected == expected, to_text(outcome)
