#!/usr/bin/env python3
"""Asks a reader all questions of the conformance suite. See README.md.

    run.py [--lacks FEATURE] [--] READER [ARGUMENT …]
    run.py --verifier VERIFIER [ARGUMENT …]

With --verifier it compares verdicts instead: exit code 0 for files that conform, 1 for others.

Exit code 0 if every answer is right, 1 at the first file with a wrong one, which is told.
"""

import argparse
import json
import pathlib
import subprocess
import sys

FOLDER = pathlib.Path(__file__).resolve().parent
CONDITIONS = ("altitude", "visibility", "albedo", "solar_elevation", "solar_azimuth")


def line(query):
    cells = [query[name] for name in CONDITIONS] + query["direction"]
    cells += [query["wavelength"], query["distance"]]
    return "\t".join([query["quantity"]] + [repr(float(cell)) for cell in cells])


def ask(reader, path, queries):
    """The reader's answers, one line each."""
    text = "".join(line(query) + "\n" for query in queries)
    done = subprocess.run(reader + [str(path)], input=text, capture_output=True, text=True, timeout=600)
    if done.returncode != 0:
        raise ValueError(f"exit code {done.returncode}: {done.stderr.strip()[-500:]}")
    answers = done.stdout.splitlines()
    if len(answers) != len(queries):
        raise ValueError(f"{len(queries)} queries, {len(answers)} answers")
    return answers


def check(query, answer, relative, lacking):
    """None, or what is wrong with an answer; and the worst share of the tolerance that was used."""
    expected_error = query.get("error")
    errors = {expected_error} - {None}
    if lacking:
        # A query may be refused before the chunk is looked at, or the chunk before the query.
        errors = {"encoding"} | (errors & {"range", "missing", "direction"})
    if errors:
        good = answer.strip() in {f"error {error}" for error in errors}
        return (None if good else f"expected error {' or '.join(sorted(errors))}"), 0.0
    try:
        values = [float(cell) for cell in answer.split()]
    except ValueError:
        return "expected numbers", 0.0
    if len(values) != len(query["expected"]):
        return f"expected {len(query['expected'])} numbers", 0.0
    worst = 0.0
    for got, expected, absolute in zip(values, query["expected"], query["absolute"]):
        tolerance = max(relative * abs(expected), absolute)
        off = abs(got - expected)
        # "not <=" also catches NaN.
        if not off <= tolerance:
            return f"expected {expected!r} ± {tolerance:.3g}", 0.0
        worst = max(worst, off / tolerance if tolerance > 0.0 else 0.0)
    return None, worst


def compare_verdicts(verifier, manifest):
    """Runs a verifier on each file."""
    for case in manifest["cases"]:
        command = verifier + [str(FOLDER / case["file"])]
        done = subprocess.run(command, capture_output=True, text=True, timeout=600)
        if done.returncode != int(case["verdict"] != "conforms"):
            output = (done.stdout + done.stderr).strip()[-500:]
            sys.exit(f"{case['file']} ({case['shows']}): expected {case['verdict']}, got exit code {done.returncode}: {output}")
    print(f"{' '.join(verifier)}: {len(manifest['cases'])} verdicts are right")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--verifier", action="store_true")
    parser.add_argument("--lacks", action="append", default=[])
    parser.add_argument("reader", nargs=argparse.REMAINDER)
    options = parser.parse_args()
    reader = [word for word in options.reader if word != "--"]
    if not reader:
        parser.error("which reader?")
    manifest = json.loads((FOLDER / "manifest.json").read_text())
    if options.verifier:
        return compare_verdicts(reader, manifest)
    files, count, worst = 0, 0, 0.0
    for case in manifest["cases"]:
        lacking = [feature for feature in case["needs"] if feature in options.lacks]
        if lacking and lacking != ["zstd"]:
            continue
        try:
            answers = ask(reader, FOLDER / case["file"], case["queries"])
        except (ValueError, OSError, subprocess.TimeoutExpired) as error:
            sys.exit(f"{case['file']} ({case['shows']}): {error}")
        wrong = []
        for query, answer in zip(case["queries"], answers):
            complaint, share = check(query, answer, manifest["relative_tolerance"], lacking)
            worst = max(worst, share)
            if complaint:
                wrong.append(f"  {line(query)}\n    {complaint}, got {answer!r}")
        if wrong:
            more = f"\n  and {len(wrong) - 5} more" if len(wrong) > 5 else ""
            sys.exit(f"{case['file']} ({case['shows']}):\n" + "\n".join(wrong[:5]) + more)
        files += 1
        count += len(answers)
    print(f"{' '.join(reader)}: {count} answers about {files} files are right, worst uses {100 * worst:.2f} % of its tolerance")


if __name__ == "__main__":
    main()
