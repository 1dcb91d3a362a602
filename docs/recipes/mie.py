"""Errors of two models beside each other, as a table for the page."""

import csv
import sys

NAMES = {"recipe": "HG", "mie": "spheres"}
FIGURES = {"median, %": "median, %", "p95, %": "p95", "max, %": "largest", "polarisation, median": "polarisation"}


def main(path, quality):
    with open(path, encoding="utf-8", newline="") as file:
        lines = file.read().splitlines()
    costs = [line[2:] for line in lines if line.startswith("# ")]
    rows = list(csv.DictReader(line for line in lines if not line.startswith("# ")))
    print(f"# Printed by `bash docs/recipes/mie {quality}`: models of continental-average air for the ground against the")
    print("# tracer with spheres, under suns at 5, 20 and 60°, at 343, 430, 550, 650 and 870 nm. Polarisation is the median")
    print("# difference of the degree of linear polarisation, HG are Henyey–Greenstein functions.")
    for cost in costs:
        model, figures = cost.split(": ", 1)
        print(f"# {NAMES[model]}: {figures}.")
    models = list(dict.fromkeys(row["model"] for row in rows))
    places = list(dict.fromkeys(row["part of the sky"] for row in rows))
    found = {(row["model"], row["part of the sky"]): row for row in rows}
    table = csv.writer(sys.stdout, lineterminator="\n")
    first, *others = FIGURES.values()
    heads = ([f"{NAMES[model]}: {first}", *others] for model in models)
    table.writerow(["part of the sky", *(name for head in heads for name in head)])
    for place in places:
        table.writerow([place, *(found[model, place][figure] for model in models for figure in FIGURES)])


if __name__ == "__main__":
    main(*sys.argv[1:])
