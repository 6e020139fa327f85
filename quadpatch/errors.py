"""Everything that the method raises on purpose.

::

    QuadpatchError              code
    ├── MeshError
    │   ├── ReadError           unreadable_mesh       the bytes are no mesh of that format
    │   ├── FormatError         unsupported_format    a format or feature that is not read or written
    │   │   └── EncodedMeshError  mesh_encoded        a .qpz file, which has to be decoded before anything else
    │   ├── EmptyMeshError      empty_mesh            no vertex or no face
    │   ├── NotFiniteError      not_finite            infinite or NaN coordinates
    │   ├── CoordinateRangeError  coordinate_out_of_range  coordinates of a size that no scan has
    │   ├── PrecisionError      precision_lost        a format whose numbers are too short for the mesh
    │   ├── IndexRangeError     index_out_of_range    a face names a vertex that is not there
    │   └── TooLargeError       mesh_too_large        over a limit of the reader
    ├── TextureError            unusable_texture      a texture image that can't be carried on; no repair ends by it
    │   ├── ImageMissingError   image_missing         it is not there
    │   ├── ImageUnreadableError  image_unreadable    its bytes are no image that is read
    │   └── ImageTooLargeError  image_too_large       over a limit of bytes or pixels
    ├── OptionError             invalid_option        an option outside its range, an unknown hole id
    ├── ModelError              unusable_model        a model file that is broken or of the wrong kind
    ├── TorchMissingError       torch_missing         a network is to be fitted, and torch is not installed
    ├── ProcessLostError        process_lost          a process that shared the work has ended
    └── StageError              stage_failed          a stage could not do its work on this mesh
        └── NoQuadsError        no_quads              the base surface is too small or too thin for one quad

Tested in `tests/test_documents.py`.
"""

import signal

from quadpatch_rules.text import printable


class QuadpatchError(Exception):
    """Base of all errors of the method; `code` is stable and meant for programs.

    Parameters
    ----------
    message : str
        For people, in one line; words of the file may stand in it as they are.
    """

    code = "quadpatch_error"

    def __init__(self, message: str = "") -> None:
        super().__init__(printable(message))


class MeshError(QuadpatchError):
    """The mesh itself can't be worked on."""

    code = "invalid_mesh"


class ReadError(MeshError):
    """The bytes are no mesh of that format."""

    code = "unreadable_mesh"


class FormatError(MeshError):
    """A format, or a feature of one, that is not read or written here."""

    code = "unsupported_format"


class EncodedMeshError(FormatError):
    """A `.qpz` file, which has to be decoded before anything else."""

    code = "mesh_encoded"


class EmptyMeshError(MeshError):
    """No vertex or no face."""

    code = "empty_mesh"


class NotFiniteError(MeshError):
    """Infinite or NaN coordinates."""

    code = "not_finite"


class CoordinateRangeError(MeshError):
    """Coordinates of a size that no scan has, as of a file that is read in the wrong way."""

    code = "coordinate_out_of_range"


class PrecisionError(MeshError):
    """The numbers of a format are too short for the mesh: triangles would collapse."""

    code = "precision_lost"


class IndexRangeError(MeshError):
    """A face names a vertex that is not there."""

    code = "index_out_of_range"


class TooLargeError(MeshError):
    """Over a limit of the reader."""

    code = "mesh_too_large"


class TextureError(QuadpatchError):
    """A texture image that can't be carried on. It is told in a warning, and the repair goes on without it."""

    code = "unusable_texture"


class ImageMissingError(TextureError):
    """An image that is not where the mesh says, or that the mesh names in no way that is understood."""

    code = "image_missing"


class ImageUnreadableError(TextureError):
    """Bytes that are no image of a format that is read, or broken ones."""

    code = "image_unreadable"


class ImageTooLargeError(TextureError):
    """An image of more bytes or pixels than are read."""

    code = "image_too_large"


class OptionError(QuadpatchError):
    """An option outside its range, or one that does not fit the mesh."""

    code = "invalid_option"


class ModelError(QuadpatchError):
    """A model file that is broken, or of the wrong kind."""

    code = "unusable_model"


class TorchMissingError(QuadpatchError):
    """A network is to be fitted, and torch is not installed."""

    code = "torch_missing"


class ProcessLostError(QuadpatchError):
    """A process that shared the work ended before it was done: killed, or out of memory.

    Parameters
    ----------
    status : int
        Its exit code, negative for a signal.
    """

    code = "process_lost"

    def __init__(self, status: int) -> None:
        self.status = status
        how = signal.Signals(-status).name if status < 0 else f"exit code {status}"
        super().__init__(f"a process that shared the work ended by {how}")


class StageError(QuadpatchError):
    """A stage could not do its work on this mesh."""

    code = "stage_failed"


class NoQuadsError(StageError):
    """The base surface is too small or too thin to carry one quad."""

    code = "no_quads"
