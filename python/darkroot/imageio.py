"""A plugin for imageio: ``imageio.v3.imread("x.nef")`` develops.

>>> import darkroot.imageio
>>> darkroot.imageio.register()
>>> import imageio.v3
>>> imageio.v3.imread(sample).shape
(480, 720, 3)
>>> imageio.v3.imread(sample, look="linear", dtype="float32").dtype
dtype('float32')
"""

import imageio.config
import numpy
from imageio.core.request import InitializationError, IOMode, Request
from imageio.core.v3_plugin_api import ImageProperties, PluginV3

import darkroot


class Plugin(PluginV3):
    """Reads raw files. Keywords of ``imread`` are those of :meth:`darkroot.Photo.develop`."""

    def __init__(self, request: Request) -> None:
        super().__init__(request)
        if request.mode.io_mode != IOMode.read:
            raise InitializationError("raw files are read, not written")
        try:
            self._photo = darkroot.open(request.get_file().read())
        except darkroot.FileError as fault:
            # Another plugin may read it.
            raise InitializationError(str(fault)) from fault

    def read(self, *, index=0, **settings):
        """The developed picture; there is one."""
        if index not in (0, None, ...):
            raise IndexError("a raw file has one picture")
        picture = self._photo.develop(**settings)
        return picture if index == 0 else picture[numpy.newaxis]

    def iter(self, **settings):
        """The developed picture, and no other."""
        yield self.read(**settings)

    def write(self, *_, **__):
        """Nothing is written."""
        raise NotImplementedError("raw files are read, not written")

    def properties(self, index=0, **settings):
        """Shape and type of what :meth:`read` gives, without developing at full size."""
        told = self._photo.explain(**{k: v for k, v in settings.items() if k != "dtype"})
        part = self._photo.develop(region=(0, 0, 1, 1), **settings)
        return ImageProperties(shape=(told["height"], told["width"], 3), dtype=part.dtype)

    def metadata(self, index=0, exclude_applied=True):
        """What the camera wrote about the shot."""
        return {"camera": self._photo.camera, **self._photo.metadata}

    def close(self):
        """Lets the samples go."""
        if hasattr(self, "_photo"):
            self._photo.close()
        super().close()


def register():
    """Makes imageio take this plugin first for the endings of raw files."""
    name = "darkroot"
    imageio.config.known_plugins[name] = imageio.config.PluginConfig(
        name=name, class_name="Plugin", module_name="darkroot.imageio", is_legacy=False, install_name="darkroot"
    )
    for ending in darkroot.ENDINGS:
        known = imageio.config.known_extensions.setdefault(f".{ending}", [])
        if known and known[0].priority and known[0].priority[0] == name:
            continue
        described = imageio.config.FileExtension(name="Raw photograph", extension=f".{ending}", priority=[name])
        known.insert(0, described)
        imageio.config.extension_list.append(described)
