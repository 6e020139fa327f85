"""The life of one proof of a published model."""

import logging
from dataclasses import replace

from jobkit.errors import QueueUnavailableError, StaleAttemptError
from jobkit.proofs import Proof
from jobkit.reconcile import submit_proof
from jobkit.schema import ModelProblem, ResolvedModel
from worker.context import Context
from worker.failures import OUTAGE_DELAY_S, EngineFailedError, Failure, StopReason
from worker.folders import request_folder
from worker.limits import EngineLimits
from worker.models import model_argument, network_card
from worker.outcomes import outcome_of
from worker.pulse import Pulse, Vitals
from worker.request import EngineRequest
from worker.watch import Observer, run_engine

# The widest networks known answer the probes within seconds.
_TIME_LIMIT_S = 120.0

_log = logging.getLogger("quadpatch.worker.proofs")


def prove(context: Context, proof: Proof) -> None:
    """Work on a started proof and settle it."""
    outcome = outcome_of(lambda: _run(context, proof), f"the proof of model {proof.reference}")
    try:
        _settle(context, proof, outcome)
    except StaleAttemptError as error:
        _log.warning("the proof may write no more: %s", error)
    else:
        _log.info("model %s: %s", proof.reference, _in_words(outcome))


def _run(context: Context, proof: Proof) -> None:
    with Pulse(_vitals(context, proof)) as pulse:
        _work(context, proof, pulse)


def _work(context: Context, proof: Proof, pulse: Pulse) -> None:
    settings, model = context.settings, proof.model
    pinned = ResolvedModel(requested=proof.reference, kind=model.kind, name=model.name, version=model.version)
    path = model_argument(pinned, context.registry, context.store, context.cache_folder)
    limits = EngineLimits(
        min(settings.job_time_limit_s, _TIME_LIMIT_S), settings.job_memory_limit_mb, n_threads=context.n_threads
    )
    card = network_card(pinned, context.registry)
    request = EngineRequest(task="prove", source="", limits=limits, model=path, model_card=card)

    def stop_reason() -> StopReason | None:
        return StopReason.DRAINED if context.draining.is_set() else pulse.stop_reason

    with request_folder(context.work_folder) as folder:
        try:
            run_engine(context.nursery, request, folder, Observer(pulse.reach, stop_reason, pulse.note_memory))
        except EngineFailedError as error:
            # The file goes by its sha256 here, which says less to people than its name.
            message = error.failure.message.replace(f"{model.sha256}.{model.format}", proof.reference)
            raise EngineFailedError(replace(error.failure, message=message)) from error


def _vitals(context: Context, proof: Proof) -> Vitals:
    proofs, settings = context.proofs, context.settings
    return Vitals(
        renew=lambda memory_mb: proofs.renew(proof, settings.lease_s),
        is_canceled=lambda: False,
        report=lambda stage, percent: None,
        heartbeat_s=settings.heartbeat_s,
    )


def _settle(context: Context, proof: Proof, outcome: Failure | StopReason | None) -> None:
    if outcome is None:
        context.proofs.accept(proof)
        return
    if outcome is StopReason.LOST:
        raise StaleAttemptError(f"the proof of model {proof.reference} lost its lease")
    if isinstance(outcome, Failure) and outcome.is_outside:
        # The dispatcher puts it into the queue again when the time has come.
        context.proofs.forgive(proof, OUTAGE_DELAY_S)
        return
    if isinstance(outcome, Failure) and (not outcome.retryable or proof.is_last):
        context.proofs.refuse(proof, ModelProblem(code=outcome.code, message=outcome.message))
        return
    if outcome is StopReason.DRAINED:
        context.proofs.forgive(proof)
    else:
        context.proofs.release(proof)
    try:
        submit_proof(context.database, context.queue, proof.reference)
    except QueueUnavailableError:
        _log.warning("the queue does not answer; model %s is put into it later", proof.reference)


def _in_words(outcome: Failure | StopReason | None) -> str:
    if outcome is None:
        return "proven"
    return outcome.code if isinstance(outcome, Failure) else outcome.value
