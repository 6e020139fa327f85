"""Whether the holes of a repair meet the limits of its spec, and what that does to the job."""

import json
from pathlib import Path
from typing import Any

from quadpatch.formats.output_files import write_whole
from quadpatch_client.schema import Accepted, JobSpec
from quadpatch_rules.acceptance import judge, unmet_in_words
from quadpatch_rules.coded_warnings import CodedWarning, Value, add_warning
from worker.engine.request import REPORT_NAME
from worker.failures import EngineFailedError, Failure


def check_acceptance(folder: Path, spec: JobSpec) -> None:
    """Write into the report in a request's folder what comes of the spec's limits; nothing where it has none.

    Raises
    ------
    EngineFailedError
        `acceptance_not_met`, if a hole does not meet them and the spec says that the job fails then.
    """
    if spec.acceptance is None:
        return
    path = folder / REPORT_NAME
    report: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    limits = spec.acceptance.model_dump()
    accepted = Accepted.model_validate(judge(report["holes"], limits))
    if not accepted.is_met:
        message = unmet_in_words(accepted.model_dump(), spec.rule, limits)
        if spec.acceptance.otherwise == "fail":
            raise EngineFailedError(Failure("acceptance_not_met", message, "judge"))
        missed: dict[str, Value] = {"missed": len(accepted.unmet), "holes": accepted.holes, "rule": spec.rule or ""}
        add_warning(report, CodedWarning(message, "limits_missed", missed))
    report["acceptance"] = accepted.model_dump(mode="json")
    write_whole(path, json.dumps(report).encode())
