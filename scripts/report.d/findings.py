#!/usr/bin/env python3
"""What a report has found, in up to ten sentences: reads what the studies left in its folder, and prints an HTML list.

    scripts/report.d/findings.py DIR

A study that is not there says nothing.
"""
import csv
import html
import json
import pathlib
import re
import sys


def read_rows(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def number(text):
    try:
        return float(text.replace(",", "").rstrip("x%"))
    except ValueError:
        return None


def printed_rows(path):
    """Rows of the first table of a printed text, cut where its rule says."""
    if not path.exists():
        return []
    lines = path.read_text(encoding="utf-8").splitlines()
    at = next((i for i, line in enumerate(lines) if re.fullmatch(r"-+( {2,}-+)+", line)), None)
    if at is None:
        return []
    columns = [part.span() for part in re.finditer(r"-+", lines[at])]
    rows = []
    for line in lines[at + 1:]:
        if not line.strip():
            break
        rows.append([line[begin:end].strip() for begin, end in columns])
    return rows


def frames(out):
    rows = [row for row in printed_rows(out / "bench.txt") if len(row) >= 11 and number(row[10])]
    if not rows:
        return None
    slow, fast = (pick(rows, key=lambda row: number(row[7])) for pick in (min, max))
    ratios = [number(row[10]) for row in rows]
    return (f"Whole frames of {len(rows)} scenes of the paper, with shadows and PNG: {slow[7]} ({slow[0]}) to {fast[7]} "
            f"({fast[0]}) per second, {min(ratios):g} to {max(ratios):g} times as many as the paper's program made.")


def simulation(out):
    rows = [row for row in printed_rows(out / "bench.txt") if len(row) >= 7 and number(row[5])]
    if not rows:
        return None
    ratios = [number(row[5]) for row in rows]
    return (f"The simulation alone, on one thread, is {min(ratios):,.3g} to {max(ratios):,.0f} times as fast as the paper's "
            "program was with its pictures, on its machine of 2009.")


def methods(out):
    path = out / "methods.csv"
    if not path.exists():
        return None
    words = {"0": "hold", "7": "cross", "5": "diverge", "3": "refused"}
    count = {}
    for row in read_rows(path):
        count.setdefault(row["method"], []).append(words.get(row["code"], "other"))
    both = [count.get(method, []) for method in ("corrected", "paper")]
    if not all(both):
        return None
    ours, paper = both
    return (f"By default no body passes through another in {ours.count('hold')} of {len(ours)} scenes; by the paper's method "
            f"in {paper.count('hold')}, while {paper.count('cross')} cross, {paper.count('diverge')} diverge and "
            f"{paper.count('refused')} cannot be run.")


def errors(out):
    ratios = []
    for path in [*sorted(out.glob("error*/*_ratios.csv")), *sorted(out.glob("solvers/*_ratios.csv"))]:
        for row in read_rows(path):
            ratio = number(row.get("sundials_over_ours") or "")
            if ratio and abs(float(row["error"]) / 1e-3 - 1) < 1e-6:
                ratios.append((ratio, row["scene"], row["our_method"]))
    if not ratios:
        return None
    low, high = min(ratios), max(ratios)
    return (f"For an error of a thousandth of the radius the best of SUNDIALS takes {low[0]:.3g} ({low[1]}, beside {low[2]}) to "
            f"{high[0]:.3g} times ({high[1]}, beside {high[2]}) as long as the best of our integrators.")


def drift(out):
    for path in sorted(out.glob("choices/*.json")):
        found = find_key(json.loads(path.read_text(encoding="utf-8")), "sentence")
        if found:
            return found[0].upper() + found[1:].rstrip(".") + "."
    return None


def find_key(node, key):
    if isinstance(node, dict):
        if isinstance(node.get(key), str):
            return node[key]
        node = list(node.values())
    for child in node if isinstance(node, list) else []:
        found = find_key(child, key)
        if found:
            return found
    return None


def stability(out):
    ratios = []
    for path in sorted(out.glob("stability/*_limits.csv")):
        for row in read_rows(path):
            found, predicted = number(row["stable_step_s"] or ""), number(row["predicted_step_s"] or "")
            if found and predicted:
                ratios.append(found / predicted)
    if not ratios:
        return None
    return (f"The longest stable step found lies at {min(ratios):.3f} to {max(ratios):.3f} of the predicted one, over "
            f"{len(ratios)} pairs of integrator and material.")


def collision(out):
    path = out / "collision" / "collision.csv"
    if not path.exists():
        return None
    parts = [float(row["regions_found"]) / float(row["regions"]) for row in read_rows(path)
             if row["search"] == "particles" and number(row["regions"] or "") and number(row["regions_found"] or "") is not None]
    if not parts:
        return None
    parts.sort()
    return (f"The paper's particles find {100 * parts[0]:.3g} to {100 * parts[-1]:.3g} % of the regions where bodies touch, "
            f"half of the settings tried at least {100 * parts[len(parts) // 2]:.3g} %.")


def extremes(out):
    path = out / "extremes" / "extremes.csv"
    if not path.exists():
        return None
    rows = read_rows(path)
    good = sum(row["as_expected"] == "true" for row in rows)
    return f"Of {len(rows)} extreme runs {good} came out as expected beforehand."


def impacts(out):
    path = out / "impacts" / "impacts.json"
    if not path.exists():
        return None
    found = json.loads(path.read_text(encoding="utf-8"))
    outcomes = ", ".join(f"{count} {name}" for name, count in found["outcomes"].items() if count)
    return f"Of {found['runs']} impacts of random bodies: {outcomes}."


def growth(out):
    path = out / "growth" / "growth.json"
    if not path.exists():
        return None
    series = json.loads(path.read_text(encoding="utf-8"))["series"]
    laws = ", ".join(f"{one['second_exponent']:.2f} ({one['pieces']})" for one in series)
    return f"The time of a simulated second grows with the number of pieces to the power {laws}."


def main():
    out = pathlib.Path(sys.argv[1])
    sentences = [find(out) for find in (frames, simulation, methods, errors, drift, stability, collision, extremes,
                                        impacts, growth)]
    for sentence in filter(None, sentences):
        print(f"<li>{html.escape(sentence)}</li>")


main()
