"""What training raises on purpose, besides the errors of the method and of the contract.

::

    TrainingError              code
    ├── MissingExtraError      missing_extra           an optional part of the installation is not there
    ├── CorpusError            unusable_corpus         a folder that is no corpus, or not one for this network
    ├── CheckpointError        unusable_checkpoint     a file that is no checkpoint, or that of another run
    ├── DivergedError          training_diverged       the loss is no number any more
    └── ExportError            export_mismatch         the exported network answers otherwise than the trained one
"""


class TrainingError(Exception):
    """Base of all errors of training networks; `code` is stable and meant for programs."""

    code = "training_failed"


class MissingExtraError(TrainingError):
    """An optional part of the installation is not there."""

    code = "missing_extra"


class CorpusError(TrainingError):
    """A folder that is no corpus, or not one for this network."""

    code = "unusable_corpus"


class CheckpointError(TrainingError):
    """A file that is no checkpoint, or the checkpoint of another run."""

    code = "unusable_checkpoint"


class DivergedError(TrainingError):
    """The loss is no number any more."""

    code = "training_diverged"


class ExportError(TrainingError):
    """The exported network answers otherwise than the trained one."""

    code = "export_mismatch"
