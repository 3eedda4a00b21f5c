"""What Jupyter shows of things."""

import base64
import html
import struct
import zlib

#: Longest side of a picture in a notebook.
LONGEST = 480


def png(picture):
    """The bytes of a PNG file of an array of ``uint8``, height x width x 3."""
    height, width, _ = picture.shape
    rows = b"".join(b"\0" + row.tobytes() for row in picture)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b"")


def table(rows):
    """Names and values as a table; what is ``None`` is left out."""
    one = "<tr><th style='text-align:left'>{}</th><td style='text-align:left'>{}</td></tr>"
    cells = (one.format(html.escape(name), html.escape(str(value))) for name, value in rows if value is not None)
    return f"<table>{''.join(cells)}</table>"


def photo(photo):
    """A small picture and what the camera wrote."""
    longest = max(photo.crop[2:])
    halvings = next((n for n in range(7) if longest >> n <= LONGEST), 6)
    small = base64.b64encode(png(photo.develop(scale=1 / 2**halvings, dtype="uint8"))).decode()
    facts = photo.metadata
    _, _, width, height = photo.crop
    rows = [
        ("file", photo.name),
        ("camera", photo.camera),
        ("picture", f"{width} x {height}"),
        ("filters", photo.cfa),
        ("lens", facts["lens"]),
        ("exposure", _exposure(facts)),
        ("taken", facts["date"]),
        ("notes", "; ".join(photo.notes) or None),
    ]
    return f'<img src="data:image/png;base64,{small}">{table(rows)}'


def _exposure(facts):
    time, number, iso = facts["exposure_time"], facts["f_number"], facts["iso"]
    time = None if time is None else f"{time:g} s" if time >= 1 else f"1/{1 / time:.0f} s"
    parts = [time, number and f"f/{number:g}", iso and f"ISO {iso:g}"]
    return ", ".join(part for part in parts if part) or None


def page(text):
    """A whole page inside of another, which neither of them can change."""
    return f'<iframe srcdoc="{html.escape(text)}" style="width:100%;height:640px;border:0"></iframe>'
