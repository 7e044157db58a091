#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints a study as the tables of RESULTS.md: study_table.py study.json"""
import json
import sys

MEASURES = ["hull", "initial", "side", "terminating", "enclosed"]


def thousands(number):
    return f"{number:,}"


def apart(ours, paper):
    return f"{100 * (ours / paper - 1):+.1f} %"


def print_rows(rows):
    print("| case | level | paper: simplices / vertices | ours | apart | errors of hull, initial cap, side, "
          "terminating cap, enclosed | s | bytes |")
    print("|---|---|---|---|---|---|---|---|")
    for row in rows:
        counts, paper = row["counts"], row["paper"]
        cells = counts["cells"]
        errors = ", ".join(f"{row['measures'][name]['error']:+.1e}" for name in MEASURES)
        print(f"| {row['case']} | {row['level']} "
              f"| {thousands(paper['cells'])} / {thousands(paper['vertices'])} "
              f"| {thousands(cells)} / {thousands(counts['vertices'])} "
              f"| {apart(cells, paper['cells'])} / {apart(counts['vertices'], paper['vertices'])} "
              f"| {errors} | {sum(row['seconds'].values()):.2f} | {row['peak_bytes'] / cells:.1f} |")


def print_rates(rates):
    print("| case | levels | orders of hull, initial cap, side, terminating cap, enclosed | growth of CPU time, of memory |")
    print("|---|---|---|---|")
    for rate in rates:
        orders = ", ".join(f"{rate['order'][name]:.2f}" for name in MEASURES)
        print(f"| {rate['case']} | {rate['levels']} | {orders} "
              f"| {rate['time_growth']:.2f}, {rate['memory_growth']:.2f} |")


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        study = json.load(file)
    print_rows(study["rows"])
    print()
    print_rates(study["rates"])


main()
