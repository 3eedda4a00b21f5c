"""What can go wrong, by whose fault it is. The message of each is the sentence that the program says."""


class Error(Exception):
    """Anything that goes wrong in Darkroot. Raised itself only for a fault of the program."""


class FileError(Error, ValueError):
    """The file's fault: it is damaged, is no raw photograph, or is beyond the limits."""


class UnsupportedError(FileError):
    """The file is sound, but its camera or its compression is not known here."""


class SettingsError(Error, ValueError):
    """The caller's fault: no such setting, a value that it does not have, settings that contradict each other."""


class ProfileError(Error, ValueError):
    """A profile, spectra or colours that cannot be used, or from which nothing can be fitted."""


class ChartError(Error, ValueError):
    """A shot of a chart, a chart or a reference that cannot be used."""


class StorageError(Error, OSError):
    """The system's fault: a file that cannot be read or written, a full disk."""


class MissingError(StorageError, FileNotFoundError):
    """There is no such file."""


class ExistsError(StorageError, FileExistsError):
    """The output exists, and ``overwrite`` was not said."""


class Cancelled(Error):
    """Somebody called :meth:`darkroot.Cancel.cancel`."""


for _class in list(vars().values()):
    if isinstance(_class, type) and issubclass(_class, Error):
        # Under the name by which people import it.
        _class.__module__ = "darkroot"
