"""What the groups of operations are about.

Tested in `tests/service/contract/test_document.py`.
"""

from collections.abc import Mapping

TAGS: Mapping[str, str] = {
    "meshes": "Upload meshes, look at what the analysis found, fetch and delete them.",
    "uploads": "Uploads that can be resumed after a broken connection, by the protocol tus 1.0.",
    "jobs": "Start jobs, follow, cancel and repeat them.",
    "batches": "Many jobs at once: start, follow, cancel, fetch and repeat them.",
    "results": "Repaired meshes, reports and pictures of jobs that have ended.",
    "views": "What a viewer shows of meshes, results and models; made when they are first asked for.",
    "retention": "Keep jobs and meshes that would expire.",
    "models": "Dictionaries and networks: versions, aliases, deprecation.",
    "trainings": "Learn dictionaries and fit networks from uploaded meshes, judge them, and publish them as models.",
    "shadows": "Candidates that run beside what jobs ask for, on a share of them: compared, never delivered.",
    "rules": "What is done with holes and what results have to meet, saved under names.",
    "webhooks": "Subscriptions to what happens to jobs, and the log of deliveries.",
    "access": "Keys of clients, and the log of who did what.",
    "service": "State, metrics and description of the service.",
}
