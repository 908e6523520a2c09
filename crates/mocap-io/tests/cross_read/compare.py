#!/usr/bin/env python3
"""Compares our C3D reader with ezc3d and py-c3d and writes the result as Markdown.

    pip install ezc3d c3d numpy
    cargo build --release -p mocap-io --example dump_c3d
    python compare.py DATA_FOLDER target/release/examples/dump_c3d docs/c3d-conformance.md

Exit status 1 when a value differs from one on which the two other readers agree and no explanation below covers the
file, or when a file we wrote is not read by both of them (SGI: ezc3d reads none; a patched file may be refused by who
refuses its source).
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
NO_SGI = "ezc3d does not read SGI files."
UNSIGNED = (
    "The residual word of each missing sample is the float 65535, the unsigned image of -1, and the position is 0. By "
    "the standard the word is a signed 16-bit integer, so we mark the sample as missing; the others see a marker at the "
    "origin."
)
NO_RATE = (
    "The file has 6 analog values per frame (header word 3, ANALOG:USED) and no ANALOG:RATE. ezc3d skips none of them "
    "and slips by 24 bytes per frame: its markers jump by {ezc3d} per frame, ours and py-c3d's by {ours}."
)
NO_RESIDUAL = (
    "The residual word of the present samples is the float 1.7e38 (bytes 00 7f 00 7f), which no residual can be. py-c3d "
    "casts it to a negative integer and drops every sample; the positions are continuous."
)
OFFSET_BINARY = (
    "Channels with ANALOG:OFFSET -32768 in a file of floats rest at 32768: an unsigned offset. We and ezc3d read 0 there, "
    "py-c3d 65536."
)
TWO_DIMENSIONS = "py-c3d takes the TRIAL:ACTUAL_*_FIELD parameters of two dimensions for one."
TWICE = "py-c3d does not read groups that hold a parameter twice."

# What was found in the bytes of each file in which readers differ.
EXPLAINED = {
    "btk__PiG__PiG_Calibration-FlatFoot-Full.c3d": TWICE,
    "btk__PiG__PiG_Calibration-FlatFoot-One.c3d": TWICE,
    "btk__others__Empty.c3d": "A file of 0 bytes.",
    "c3dio__data__short-copy.c3d": (
        "POINT:DATA_START says block 14, header word 9 says 9; only 9 accounts for the file's length. The groups lack "
        "the length byte of their description."
    ),
    "c3dorg__sample_01__Eb015si.c3d": NO_SGI,
    "c3dorg__sample_01__Eb015sr.c3d": NO_SGI,
    "c3dorg__sample_02__sgi_int.c3d": NO_SGI,
    "c3dorg__sample_02__sgi_real.c3d": NO_SGI,
    "c3dorg__sample_06__MACsample.c3d": NO_SGI
    + " Header and POINT:SCALE disagree, which py-c3d refuses. By the header's scale, which we take, a shoulder is 1.49 m "
    "high, by the parameter's 0.58 m.",
    "btk__others__Analysis.c3d": OFFSET_BINARY,
    "btk__others__shd01.c3d": "ANALOG:FORMAT is UNSIGNED, so the offset -32752 is 32784, to us and py-c3d; ezc3d takes its "
    "magnitude.",
    "c3dorg__sample_07__16bitanalog.c3d": UNSIGNED + " " + OFFSET_BINARY,
    "c3dorg__sample_13__Dance.c3d": "ANALOG:OFFSET is a float, which ezc3d refuses. POINT:FRAMES says 500, the header 499; "
    "the file holds exactly 499. The parameter section is longer than it declares; py-c3d stops before ANALOG:GEN_SCALE, "
    "which is -1.",
    "c3dorg__sample_15__FP1.C3D": "The parameter section declares 3 blocks and uses 5; py-c3d stops before ANALOG:USED.",
    "c3dorg__sample_20__phasespace_sample.c3d": "The parameter section is empty. We and py-c3d read by the header; ezc3d "
    "returns no points and no error.",
    "c3dorg__sample_22__BKINtechnologies.c3d": "The description of EXPERIMENT:SESSION is 163 bytes long; without that "
    "group ezc3d reads the file.",
    "c3dorg__sample_24__MotionMonitorC3D.c3d": "Header word 3 says 16 analog values per frame; ANALOG:USED times header "
    "word 10 is 112, which accounts for the file's length. py-c3d refuses the disagreement.",
    "c3dorg__sample_26__Capture0002.c3d": UNSIGNED,
    "c3dorg__sample_26__Capture0003.c3d": UNSIGNED,
    "c3dorg__sample_26__Capture0004.c3d": UNSIGNED,
    "c3dorg__sample_26__Walking_Hybrid_1_1.c3d": UNSIGNED,
    "c3dorg__sample_26__Walking_Hybrid_1_5.c3d": UNSIGNED,
    "c3dorg__sample_28__dynamic.C3D": NO_RATE.format(ezc3d="1243 mm (median)", ours="14 mm"),
    "c3dorg__sample_28__standing.C3D": NO_RATE.format(ezc3d="454 mm (median)", ours="0.2 mm"),
    "c3dorg__sample_28__type1.C3D": NO_RATE.format(ezc3d="1278 mm (median)", ours="14 mm"),
    "c3dorg__sample_30__admarche2.c3d": NO_RESIDUAL,
    "c3dorg__sample_30__marche281.c3d": NO_RESIDUAL,
    "c3dorg__sample_35__Mega_Electronics_Isokinetic_EMG_Angle_Torque_Sample_File.c3d": "POINT:DATA_START is one byte, where "
    "py-c3d wants two.",
    "c3dorg__sample_37__ART-Human_hands_real_no6dof.c3d": TWO_DIMENSIONS,
    "c3dorg__sample_37__ART-Human_tools_integer_6dofLimbs.c3d": TWO_DIMENSIONS,
    "ktk__others__C3DRotationExample.c3d": TWO_DIMENSIONS,
    "05_13.c3d": "No analog channels, but header word 10 and ANALOG:RATE disagree, which py-c3d refuses.",
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

        data = ezc3d.c3d(file)["data"]
        points = data["points"]
        analog = np.moveaxis(data["analogs"][0], 0, 1).astype(float)
        xyz = np.moveaxis(points[:3], [0, 1, 2], [2, 1, 0]).astype(float)
        missing = np.isnan(xyz).any(-1)
    else:
        import warnings

        import c3d

        warnings.simplefilter("ignore")
        with open(file, "rb") as handle:
            read = [(points, analog) for _, points, analog in c3d.Reader(handle).read_frames(copy=True)]
        frames = [points for points, _ in read]
        # Channels by samples, frame after frame; files without channels give empty arrays of several shapes.
        parts = [np.asarray(part, dtype=float).T for _, part in read if np.size(part)]
        analog = np.concatenate(parts) if parts else np.zeros((0, 0))
        frames = np.array(frames, dtype=float).reshape(len(frames), -1, 5)
        xyz = frames[..., :3]
        missing = (frames[..., 3] < 0) | np.isnan(xyz).any(-1)
    np.savez(out, xyz=xyz, missing=missing, analog=analog)
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
        return arrays["xyz"], arrays["missing"], arrays["analog"]


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
    at = 16 + cells * 25
    samples, channels = struct.unpack_from("<QQ", raw, at)
    analog = np.frombuffer(raw, "<f8", samples * channels, at + 16).reshape(samples, channels)
    notes = [line.removeprefix("note\t") for line in done.stdout.splitlines()[1:]]
    return (xyz, state, analog), notes


def shorten(text):
    text = " ".join(text.split()).replace("|", "/")
    return text if len(text) <= 90 else text[:87] + "..."


def compare(file, dump, scratch):
    mine, notes = ours(file, dump, scratch)
    readers = {name: other(name, file, scratch) for name in ("ezc3d", "py-c3d")}
    row = {"file": file.name, "notes": notes, "ours": mine if isinstance(mine, str) else shape(mine[0], mine[1] > 0)}
    zeros = 0 if isinstance(mine, str) else int((mine[1] == 3).sum())
    row["ours"] += f", {zeros} of them zeros" if zeros else ""
    agreements, analog = [], []
    for name, theirs in readers.items():
        row[name] = theirs if isinstance(theirs, str) else shape(*theirs[:2])
        agreements.append(f"{name} {agreement(mine, theirs)}")
        analog.append(f"{name} {analog_agreement(mine, theirs)}")
    row["agreement"] = "; ".join(agreements)
    row["analog"] = "; ".join(analog)
    row["unexplained"] = contradicts(mine, *readers.values()) and file.name not in EXPLAINED
    row["explanation"] = EXPLAINED.get(file.name, "")
    same = all(part.endswith(("equal", "none")) for part in agreements + analog)
    row["same"] = same
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
    (xyz, state, _), (their_xyz, their_missing, _) = mine, theirs
    if xyz.shape != their_xyz.shape:
        return "another shape"
    # Exact zeros are missing to us and at the origin to the others: the report counts them apart.
    present = (state == 0) & ~their_missing
    wrong = int((present & ~close(xyz, their_xyz).all(-1)).sum())
    marks = int((((state == 1) | (state == 2)) != (their_missing & (state != 3))).sum())
    if wrong or marks:
        return f"{wrong} values, {marks} missing marks differ"
    return "equal"


def analog_agreement(mine, theirs):
    if isinstance(mine, str) or isinstance(theirs, str):
        return "–"
    ours, analog = mine[2], theirs[2]
    if not ours.size and not analog.size:
        return "none"
    if ours.shape != analog.shape:
        return f"shape {analog.shape} for {ours.shape}"
    # We give analog samples as 32-bit floats.
    wrong = int((np.abs(ours - analog) > 1e-6 * np.maximum(np.abs(ours), np.abs(analog)).clip(1e-6)).sum())
    return f"{wrong} of {ours.size} differ" if wrong else "equal"


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
    sources = {}
    for source in ("cmu/paired/02_01.c3d", "cmu/paired/05_13.c3d", "c3d-zoo/c3dorg__sample_01__Eb015vr.c3d"):
        target = made / ("patched_" + Path(source).name)
        sources[target.name] = data / source
        subprocess.run([str(dump), "patch", str(data / source), str(target)], check=True)
    rows = []
    for file in sorted(made.iterdir()):
        mine, _ = ours(file, dump, scratch)
        row = {"file": file.name, "ours": shape(mine[0], mine[1] > 0), "ok": True}
        for name in ("ezc3d", "py-c3d"):
            row[name] = agreement(mine, theirs := other(name, file, scratch))
            if isinstance(theirs, str):
                row[name] = theirs
            source = sources.get(file.name)
            refuses_source = source is not None and isinstance(theirs, str) and theirs == other(name, source, scratch)
            row["ok"] &= row[name] == "equal" or refuses_source or (name == "ezc3d" and "sgi" in file.name)
        rows.append(row)
    return rows


def report(rows, written):
    import c3d
    import ezc3d

    versions = f"ezc3d {ezc3d.__version__}, py-c3d {getattr(c3d, '__version__', '0.6.0')}"
    all_equal = sum(row["same"] for row in rows)
    read = sum("×" in row["ours"] for row in rows)
    head = f"""# C3D conformance

Made by `crates/mocap-io/tests/cross_read/compare.py` ({versions}) from the real recordings that `MOCAP_DATA` names.
{len(rows)} files: {read} read by `mocap_io::c3d`, {len(rows) - read} refused; in {all_equal} all three readers give equal
positions, equal missing marks and equal analog samples.

Cells give frames × points and the number of missing samples. "Equal" means: every sample present in both lies within
2.5e-7 of its magnitude (readers multiply integers by the scale in 32 or in 64 bits), and both call the same samples
missing. Exact zeros with a residual that is not negative are missing to us and at the origin to the others; they are
counted apart and are no disagreement. Analog samples are compared after scaling, to 1e-6. Where a reader refuses a file or differs, the last column says why.

| file | ours | ezc3d | py-c3d | points | analog | explanation |
|---|---|---|---|---|---|---|
"""
    lines = [
        "| {file} | {ours} | {ezc3d} | {py-c3d} | {agreement} | {analog} | {explanation} |".format(**row) for row in rows
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
