"""One proof of a published model, from its start to its result."""

from dataclasses import replace

from jobkit.jobs.memory_needs import BY_GEOMETRY, expected_from_bytes
from jobkit.models.proofs import Proof
from jobkit.requeue import submit_proof
from quadpatch_client.schema import ModelProblem, ResolvedModel
from worker.checks import Check, run_check
from worker.context import Context
from worker.engine.limits import EngineLimits
from worker.engine.request import EngineRequest
from worker.engine.supervision import Observer, run_engine
from worker.failures import EngineFailedError
from worker.folders import request_folder
from worker.models import model_argument, network_card

# The widest networks known answer the probes within seconds.
_TIME_LIMIT_S = 120.0


def prove(context: Context, proof: Proof) -> None:
    """Work on a started proof and settle it."""
    proofs = context.proofs
    check = Check(
        subject=f"the proof of model {proof.reference}",
        is_last=proof.is_last,
        renew=lambda lease_s: proofs.renew(proof, lease_s),
        refuse=lambda code, message: proofs.refuse(proof, ModelProblem(code=code, message=message)),
        release=lambda: proofs.release(proof),
        forgive=lambda delay_s: proofs.forgive(proof, delay_s),
        submit=lambda: submit_proof(context.database, context.queue, proof.reference),
        needed_mb=expected_from_bytes(BY_GEOMETRY, proof.model.size_bytes),
    )
    run_check(
        context,
        check,
        lambda observer: _work(context, proof, observer),
        lambda _: proofs.accept(proof),
        lambda _: "proven",
    )


def _work(context: Context, proof: Proof, observer: Observer) -> None:
    settings, model = context.settings, proof.model
    pinned = ResolvedModel(requested=proof.reference, kind=model.kind, name=proof.name, version=model.version)
    path = model_argument(pinned, context.registry, context.store, context.cache_folder)
    limits = EngineLimits(
        min(settings.job_time_limit_s, _TIME_LIMIT_S), settings.job_memory_limit_mb, n_threads=context.n_threads
    )
    card = network_card(pinned, context.registry)
    request = EngineRequest(task="prove", source="", limits=limits, model=path, model_card=card)
    with request_folder(context.work_folder) as folder:
        try:
            run_engine(context.fork_server, request, folder, observer)
        except EngineFailedError as error:
            # The file is named by its sha256 here; people know the model by its reference.
            message = error.failure.message.replace(f"{model.sha256}.{model.format}", proof.reference)
            raise EngineFailedError(replace(error.failure, message=message)) from error
