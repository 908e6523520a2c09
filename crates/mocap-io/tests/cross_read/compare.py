#!/usr/bin/env python3
"""Compares our C3D reader with ezc3d and py-c3d and writes the result as Markdown.

    pip install ezc3d c3d numpy
    cargo build --release -p mocap-io --example dump_c3d
    python compare.py DATA_FOLDER target/release/examples/dump_c3d docs/c3d-conformance.md

Exit status 1 when a value differs from one on which the two other readers agree and no explanation below covers the
file, or when a file we wrote is not read by both of them (SGI: ezc3d reads none).
"""

import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

SECONDS = 60
FOLDERS = ["c3d-zoo", "captures", "cmu/paired", "hdm05/paired"]

# What was found in the bytes of each file in which readers differ.
EXPLAINED = {
}


def main():
    if sys.argv[1] == "--read":
        return read_other(*sys.argv[2:])
    data, dump, out = (Path(argument) for argument in sys.argv[1:4])
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        files = sorted(
            file for folder in FOLDERS for file in (data / folder).iterdir() if file.suffix.lower() == ".c3d"
        )
        rows = [compare(file, dump, scratch) for file in files]
        written = check_written(data, dump, scratch)
    out.write_text(report(rows, written))
    bad = [row["file"] for row in rows if row["unexplained"]] + [row["file"] for row in written if not row["ok"]]
    for name in bad:
        print("to explain:", name)
    return 1 if bad else 0


def read_other(reader, file, out):
    """Runs in a process of its own, for readers that crash or hang."""
    if reader == "ezc3d":
        import ezc3d

        points = ezc3d.c3d(file)["data"]["points"]
        xyz = np.moveaxis(points[:3], [0, 1, 2], [2, 1, 0]).astype(float)
        missing = np.isnan(xyz).any(-1)
    else:
        import warnings

        import c3d

        warnings.simplefilter("ignore")
        with open(file, "rb") as handle:
            frames = [points.copy() for _, points, _ in c3d.Reader(handle).read_frames(copy=True)]
        frames = np.array(frames, dtype=float).reshape(len(frames), -1, 5)
        xyz = frames[..., :3]
        missing = (frames[..., 3] < 0) | np.isnan(xyz).any(-1)
    np.savez(out, xyz=xyz, missing=missing)
    return 0


def other(reader, file, scratch):
    out = scratch / f"{reader}.npz"
    out.unlink(missing_ok=True)
    command = [sys.executable, __file__, "--read", reader, str(file), str(out)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=False)
    except subprocess.TimeoutExpired:
        return f"no answer in {SECONDS} s"
    if done.returncode < 0:
        return f"killed by signal {-done.returncode}"
    if done.returncode:
        lines = done.stderr.strip().splitlines() or ["no message"]
        return shorten(lines[-1].replace(str(file), "FILE"))
    with np.load(out) as arrays:
        return arrays["xyz"], arrays["missing"]


def ours(file, dump, scratch):
    out = scratch / "ours.bin"
    done = subprocess.run([str(dump), "points", str(file), str(out)], capture_output=True, text=True, check=False)
    if done.returncode:
        return shorten(done.stderr.strip().removeprefix("Error: ")), []
    raw = out.read_bytes()
    frames, points = struct.unpack_from("<QQ", raw)
    cells = frames * points
    xyz = np.frombuffer(raw, "<f8", cells * 3, 16).reshape(frames, points, 3)
    state = np.frombuffer(raw, "u1", cells, 16 + cells * 24).reshape(frames, points)
    notes = [line.removeprefix("note\t") for line in done.stdout.splitlines()[1:]]
    return (xyz, state), notes


def shorten(text):
    text = " ".join(text.split()).replace("|", "/")
    return text if len(text) <= 90 else text[:87] + "..."


def compare(file, dump, scratch):
    mine, notes = ours(file, dump, scratch)
    readers = {name: other(name, file, scratch) for name in ("ezc3d", "py-c3d")}
    row = {"file": file.name, "notes": notes, "ours": mine if isinstance(mine, str) else shape(mine[0], mine[1] > 0)}
    zeros = 0 if isinstance(mine, str) else int((mine[1] == 3).sum())
    row["ours"] += f", {zeros} of them zeros" if zeros else ""
    agreements = []
    for name, theirs in readers.items():
        row[name] = theirs if isinstance(theirs, str) else shape(*theirs)
        agreements.append(f"{name} {agreement(mine, theirs)}")
    row["agreement"] = "; ".join(agreements)
    row["unexplained"] = contradicts(mine, *readers.values()) and file.name not in EXPLAINED
    row["explanation"] = EXPLAINED.get(file.name, "")
    same = all(part.endswith("equal") for part in agreements)
    row["to_explain"] = not same and file.name not in EXPLAINED
    return row


def shape(xyz, missing):
    return f"{xyz.shape[0]} × {xyz.shape[1]}, {int(missing.sum())} missing"


def close(a, b):
    # Readers multiply integers by the scale in 32 or in 64 bits: two roundings of 24 bits apart.
    return np.abs(a - b) <= 2.5e-7 * np.maximum(np.abs(a), np.abs(b))


def agreement(mine, theirs):
    if isinstance(mine, str) or isinstance(theirs, str):
        return "refuses" if isinstance(theirs, str) else "reads"
    (xyz, state), (their_xyz, their_missing) = mine, theirs
    if xyz.shape != their_xyz.shape:
        return "another shape"
    # Exact zeros are missing to us and at the origin to the others: the report counts them apart.
    present = (state == 0) & ~their_missing
    wrong = int((present & ~close(xyz, their_xyz).all(-1)).sum())
    marks = int((((state == 1) | (state == 2)) != (their_missing & (state != 3))).sum())
    if wrong or marks:
        return f"{wrong} values, {marks} missing marks differ"
    return "equal"


def contradicts(mine, a, b):
    """Whether we differ from what both others say."""
    if isinstance(a, str) or isinstance(b, str):
        return False
    if isinstance(mine, str):
        return True
    if a[0].shape != b[0].shape:
        return False
    if mine[0].shape != a[0].shape:
        return True
    agree = close(a[0], b[0]).all(-1) & ~a[1] & ~b[1]
    state = mine[1]
    values = agree & (state == 0) & ~close(mine[0], a[0]).all(-1)
    marks = (agree & ((state == 1) | (state == 2))) | (a[1] & b[1] & (state == 0))
    return bool(values.any() or marks.any())


def check_written(data, dump, scratch):
    made = scratch / "made"
    made.mkdir()
    subprocess.run([str(dump), "make", str(made)], check=True)
    for source in ("cmu/paired/02_01.c3d", "cmu/paired/05_13.c3d", "c3d-zoo/c3dorg__sample_01__Eb015vr.c3d"):
        target = made / ("patched_" + Path(source).name)
        subprocess.run([str(dump), "patch", str(data / source), str(target)], check=True)
    rows = []
    for file in sorted(made.iterdir()):
        mine, _ = ours(file, dump, scratch)
        row = {"file": file.name, "ours": shape(mine[0], mine[1] > 0), "ok": True}
        for name in ("ezc3d", "py-c3d"):
            row[name] = agreement(mine, theirs := other(name, file, scratch))
            if isinstance(theirs, str):
                row[name] = theirs
            row["ok"] &= row[name] == "equal" or (name == "ezc3d" and "sgi" in file.name)
        rows.append(row)
    return rows


def report(rows, written):
    import c3d
    import ezc3d

    versions = f"ezc3d {ezc3d.__version__}, py-c3d {getattr(c3d, '__version__', '0.6.0')}"
    all_equal = sum(row["agreement"] == "ezc3d equal; py-c3d equal" for row in rows)
    read = sum("×" in row["ours"] for row in rows)
    head = f"""# C3D conformance

Made by `crates/mocap-io/tests/cross_read/compare.py` ({versions}) from the real recordings that `MOCAP_DATA` names.
{len(rows)} files: {read} read by `mocap_io::c3d`, {len(rows) - read} refused; in {all_equal} all three readers give equal
values and equal missing marks.

Cells give frames × points and the number of missing samples. "Equal" means: every sample present in both lies within
2.5e-7 of its magnitude (readers multiply integers by the scale in 32 or in 64 bits), and both call the same samples
missing. Exact zeros with a residual that is not negative are missing to us and at the origin to the others; they are
counted apart and are no disagreement. Where a reader refuses a file or differs, the last column says why.

| file | ours | ezc3d | py-c3d | agreement | explanation |
|---|---|---|---|---|---|
"""
    lines = [
        "| {file} | {ours} | {ezc3d} | {py-c3d} | {agreement} | {explanation} |".format(**row) for row in rows
    ]
    tail = """
## Files written by us

Made by `NewC3d::encode`, or patched by `C3d::patch` (ten samples filled, one made missing), and read by the others.

| file | ours | ezc3d | py-c3d |
|---|---|---|---|
"""
    tail_lines = ["| {file} | {ours} | {ezc3d} | {py-c3d} |".format(**row) for row in written]
    notes = ["", "## Notes of our reader", ""]
    notes += [f"- {row['file']}: {'; '.join(row['notes'])}" for row in rows if row["notes"]]
    todo = [row["file"] for row in rows if row["to_explain"]]
    for name in todo:
        print("without explanation:", name)
    return head + "\n".join(lines) + "\n" + tail + "\n".join(tail_lines) + "\n" + "\n".join(notes) + "\n"


if __name__ == "__main__":
    sys.exit(main())
