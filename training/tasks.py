"""Which task trains a network: one for each recipe that corpora are cut for."""

from collections.abc import Callable

from training.architectures import Architecture
from training.errors import CorpusError
from training.paper_task import open_paper_task
from training.residual_task import open_residual_task
from training.shards import Corpus
from training.task import Task

TASKS: dict[str, Callable[[Architecture, Corpus], Task]] = {"paper": open_paper_task, "residual": open_residual_task}


def open_task(architecture: Architecture, corpus: Corpus) -> Task:
    """Join a network and its patches.

    Raises
    ------
    CorpusError
        If the corpus was cut for other networks, or one of its halves is empty.
    """
    facts = corpus.facts
    wanted, found = (architecture.recipe, architecture.resolution), (facts["recipe"], facts["resolution"])
    if found != wanted:
        raise CorpusError(
            f"{architecture.name} learns from {wanted[1]} x {wanted[1]} bins cut for the recipe {wanted[0]}; "
            f"the corpus has {found[1]} x {found[1]} bins for the recipe {found[0]}"
        )
    for split, remedy in (("train", "more meshes or --procedural"), ("validation", "--holdout or --procedural")):
        if not any(mesh["count"] for mesh in corpus.meshes(split)):
            raise CorpusError(f"the corpus has no patch for {split}: cut it with {remedy}")
    return TASKS[architecture.recipe](architecture, corpus)
