"""Drafts of recipes: their skies beside each other, and what they cost."""

import csv
import json
import resource
import subprocess
import sys
from datetime import date
from pathlib import Path

from PIL import Image, ImageDraw

SUNS = [60, 5, -3]
ALTITUDES = [0, 3000]
SIZE = 136
LABEL = 28
COLUMNS = ["recipe", "visibility, km", "bytes", "core-seconds", "values", "median, %", "p95", "p99", "largest"]
NOTE = """\
# Printed by `bash docs/recipes/sheet` on {day}, while other work went on: drafts for 0 to 3 km and suns from −4° to
# 60°, and their errors against the unbiased tracer, noise of up to 1 % included, at wavelengths beside lines from 315
# to 1050 nm. Core-seconds are those of all of it, the judgement too.
"""


def make(binaries, folder, recipe):
    """The model file and a row of the table; keeps the row beside the file."""
    out, row = folder / f"{recipe}.welkin", folder / f"{recipe}.csv"
    if out.exists() and row.exists():
        return out, row.read_text().strip().split(",")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [binaries / "welkin-fit", "make", recipe, "--out", out, "--work", folder / recipe]
    command += ["--altitudes", "0..3000", "--elevations=-4..60", "--quality", "draft"]
    report = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime - before.ru_utime
    values = [recipe, visibility(binaries, out), out.stat().st_size, f"{seconds:.0f}", *judged(report)]
    text = ",".join(map(str, values))
    row.write_text(text + "\n")
    return out, text.split(",")


def visibility(binaries, model):
    command = [binaries / "welkin", "info", "--model", model, "--json"]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout

    return f"{json.loads(text)['visibilities_km'][0]:.1f}"


def judged(report):
    """Number of values, and the quantiles of the errors in percent."""
    after = report.split("against the unbiased tracer", 1)[1]
    line = next(line for line in after.splitlines() if line.startswith("all"))
    return [cell.rstrip("%") for cell in line.split()[1:6]]


def sky(binaries, folder, model, altitude, sun):
    out = folder / f"{model.stem}-{altitude}-{sun}.png"
    command = [binaries / "welkin", "render", "--model", model, f"--sun-elevation={sun}"]
    command += ["--altitude", str(altitude), "--projection", "up", "--size", str(SIZE), "--out", out]
    subprocess.run(command, check=True, capture_output=True)
    return Image.open(out).convert("RGB")


def sheet(binaries, folder, models):
    """Recipes down, altitudes and suns across."""
    across = len(SUNS) * len(ALTITUDES)
    page = Image.new("RGB", (across * SIZE, len(models) * (SIZE + LABEL)), "black")
    draw = ImageDraw.Draw(page)
    for row, model in enumerate(models):
        top = row * (SIZE + LABEL)
        draw.text((4, top + 2), model.stem, fill="white")
        top += LABEL // 2
        for column in range(across):
            altitude, sun = ALTITUDES[column // len(SUNS)], SUNS[column % len(SUNS)]
            place = (column * SIZE, top + LABEL // 2)
            page.paste(sky(binaries, folder, model, altitude, sun).resize((SIZE, SIZE)), place)
            label = f"{altitude / 1000:g} km, sun {sun}°"
            draw.text(((column + 1) * SIZE - 4, top + 2), label, fill="gray", anchor="ra")
    return page


def main():
    binaries, folder = Path(sys.argv[1]), Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    recipes = sys.argv[3:] or sorted(p.stem for p in Path("fitter/recipes").glob("*.toml"))
    models, rows = [], []
    for recipe in recipes:
        model, row = make(binaries, folder, recipe)
        print(",".join(row), flush=True)
        models.append(model)
        rows.append(row)
    sheet(binaries, folder, models).save("docs/recipes/sheet.png", optimize=True)
    with open("docs/figures/made.csv", "w", newline="") as file:
        file.write(NOTE.format(day=date.today()))
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(rows)


main()
