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


def light(figures, patches):
    """Figures of a profile under one light, with a plot of its patches."""
    rows = [("model", figures["model"]), ("temperature", f"{figures['kelvin']:.0f} K")]
    for name, words in [
        ("left_out", "colours left out"),
        ("held_out", "other colours"),
        ("training", "colours of the fit"),
    ]:
        if figures[name]:
            rows.append((f"dE2000, {words}", "mean {mean:.2f}, 95 % {p95:.2f}, max {max:.2f}".format(**figures[name])))
    plot = swatches([p["name"] for p in patches], [p["xyz"] for p in patches], [p["de2000"] for p in patches])
    return f"<h4>{html.escape(figures['light'])}</h4>{table(rows)}{plot}"


def gates(gates):
    """Checks of a shot."""
    return table((gate["verdict"], "; ".join(filter(None, [gate["words"], gate["advice"]]))) for gate in gates)


#: XYZ relative to D50 to linear sRGB (Bradford).
TO_SRGB = (
    (3.1338561, -1.6168667, -0.4906146),
    (-0.9787684, 1.9161415, 0.0334540),
    (0.0719453, -0.2289914, 1.4052427),
)


def css(xyz):
    """A colour as CSS has it."""

    def code(linear):
        linear = min(max(linear, 0.0), 1.0)
        return round(255 * (12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055))

    r, g, b = (code(sum(m * v for m, v in zip(row, xyz))) for row in TO_SRGB)
    return f"rgb({r},{g},{b})"


def swatches(names, colours, errors=None):
    """Colours in a grid; below each its error, as a number and a bar."""
    side, columns = 56, 12
    parts = []
    for i, (name, xyz) in enumerate(zip(names, colours)):
        x, y = (i % columns) * side, (i // columns) * (side + 14)
        parts.append(f'<rect x="{x}" y="{y}" width="{side - 4}" height="{side - 16}" fill="{css(xyz)}"/>')
        words = html.escape(str(name))
        if errors is not None:
            length = min(errors[i] / 5, 1) * (side - 4)
            parts.append(f'<rect x="{x}" y="{y + side - 14}" width="{length:.1f}" height="3" fill="#c33"/>')
            words += f" {errors[i]:.1f}"
        parts.append(f'<text x="{x}" y="{y + side}" font-size="9">{words}</text>')
    rows = -(-len(names) // columns)
    size = f'width="{columns * side}" height="{rows * (side + 14)}"'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="sans-serif">{"".join(parts)}</svg>'
        if parts
        else ""
    )
