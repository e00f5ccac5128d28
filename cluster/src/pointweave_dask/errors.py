"""What goes wrong, with a code for programs and a sentence for people."""

from __future__ import annotations


class PointweaveError(Exception):
    """A step failed, and so would the same step again.

    ``code`` is one of

    - ``usage``: an option or an input that cannot be meant as it stands;
    - ``failed``: the command line said what is wrong, and ``message`` is its line;
    - ``killed``: Node was ended from outside, most often for want of memory;
    - ``worker-lost``: a task's worker died more often than Dask tries again;
    - ``store``: files could not be read or written, after all retries;
    - ``cancelled``: the scheduler dropped the work, or is gone;
    - ``version``: the scheduler or a worker has another version of this package or of Dask, or none;
    - ``no-node``, ``no-package``: Node or the npm package is not there.
    """

    def __init__(self, code: str, message: str) -> None:
        super().__init__(code, message)
        self.code = code
        self.message = message

    def __str__(self) -> str:
        return self.message
