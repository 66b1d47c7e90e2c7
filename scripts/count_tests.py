# SPDX-License-Identifier: Apache-2.0
"""Counts a ctest report: names what was skipped, ends with 'N passed, N failed, N skipped', fails
unless all passed."""

import sys
import xml.etree.ElementTree as ElementTree


def main() -> int:
    try:
        cases = ElementTree.parse(sys.argv[1]).getroot().findall("testcase")
    except (OSError, ElementTree.ParseError) as error:
        print(f"error: {sys.argv[1]}: no test report: {error}", file=sys.stderr)
        return 1
    passed, failed, skipped = [], [], []
    for case in cases:
        if case.get("status") == "fail" or case.find("failure") is not None:
            failed.append(case.get("name"))
        elif case.get("status") == "run" and case.find("skipped") is None:
            passed.append(case.get("name"))
        else:  # skipped, disabled or never run: all the same to whoever trusts the count
            skipped.append(case.get("name"))
    for name in failed:
        print(f"failed: {name}")
    for name in skipped:
        print(f"skipped: {name}")
    print(f"{len(passed)} passed, {len(failed)} failed, {len(skipped)} skipped")
    return 0 if passed and not failed and not skipped else 1


if __name__ == "__main__":
    sys.exit(main())
