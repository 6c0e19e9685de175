#!/usr/bin/env python3
"""Measures how much sequences of `whitewater render` change from frame to frame beyond steady motion.

  flicker.py --data DIR --out DIR [--sequences FILE.toml] [--only NAME]... [--whitewater PROGRAM] [--arguments ARGUMENTS] [--table FILE.md]

README.md says what is measured. Writes to DIR the frames, all numbers (flicker.json), a table (flicker.md), and of each
sequence the frame that changes most in each kind of pixels, beside eight times its change (NAME_KIND.png).
"""
import argparse
import datetime
import json
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tomllib

import numpy as np

import particles

HERE = pathlib.Path(__file__).parent
LUMA = np.array([0.2126, 0.7152, 0.0722])
NEAR = 8  # pixels at 640x360 that mist, a silhouette or a mirrored edge may reach
STILL = 0.1  # pixels of motion between two frames
KINDS = ["background", "still water", "moving water"]


def run(command):
    ran = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if ran.returncode:
        sys.exit(f"flicker: {shlex.join(map(str, command))} failed: {ran.stderr.strip()}")


def rest(sequence, folder):
    """Files of a pool at rest; the pattern of their names."""
    points = particles.pool(sequence["radius"], sequence["box"], **sequence["pool"])
    for old in folder.glob("rest_*.npz"):
        old.unlink()
    random = np.random.default_rng(2)
    for k in range(sequence["frames"]):
        moved = points + random.normal(0, 0.002 * sequence["radius"], points.shape)
        speed = random.normal(0, 1e-3, points.shape)
        np.savez(folder / f"rest_{k}.npz", position=moved.astype("f4"), velocity=speed.astype("f4"), id=np.arange(len(points)))
    return folder / "rest_%d.npz"


def draw(name, sequence, options):
    """Folder of the frames: s.NNNN.png and .exr as drawn by default, w.NNNN.exr without surface foam and spray."""
    folder = options.out / name
    folder.mkdir(parents=True, exist_ok=True)
    arguments = shlex.split(sequence.get("arguments", ""))
    if "pool" in sequence:
        source = rest(sequence, folder)
        arguments += ["--radius", sequence["radius"], "--fps", 30]
    elif "simulate" in sequence:
        kind = sequence["simulate"]
        cache = options.out / f"cache_{kind}"
        # scene.json is written with each frame, so only the last frame says that all are there.
        last = int(re.search(r"--frames[= ]\d+-(\d+)", sequence["arguments"])[1])
        if not (cache / f"{kind}_{last:04}.bgeo").exists():
            shutil.rmtree(cache, ignore_errors=True)
            run([options.whitewater, "simulate", kind, "--out", cache])
        source = cache / f"{kind}_%04d.bgeo"
        arguments += ["--scene", cache / "scene.json"]
    else:
        source = options.data / sequence["input"]
    if "settings" in sequence:
        settings = folder / "settings.toml"
        settings.write_text(sequence["settings"])
        arguments += ["--settings", settings]
    command = [options.whitewater, "render", source, "--size", options.size, "--layers", "water.depth,water.surface,motion",
               *arguments, *shlex.split(options.arguments)]
    if not options.keep:
        command.append("--overwrite")
        # All frames of the folder are measured, so none of an earlier run may stay.
        for old in [*folder.glob("[sw].*.exr"), *folder.glob("[sw].*.png")]:
            old.unlink()
    run([*command, "-o", folder / "s.%04d.exr", "-o", folder / "s.%04d.png"])
    run([*command, "--surface-foam", "none", "--spray", "none", "-o", folder / "w.%04d.exr", "-o", folder / "w.%04d.png"])
    return folder


def grown(mask, pixels):
    """Pixels within so many of a mask's, along rows and columns in turn."""
    for axis in (0, 1):
        sums = np.cumsum(np.pad(mask.astype("i4"), [(pixels + 1, pixels) if a == axis else (0, 0) for a in (0, 1)]), axis)
        count = mask.shape[axis]
        mask = np.take(sums, np.arange(count) + 2 * pixels + 1, axis) - np.take(sums, np.arange(count), axis) > 0
    return mask


def shaded(depth, fov):
    """Brightness, 0 to 255, of what has an eye depth, lit from the eye: the cosine of its slope. `fov`: degrees, vertical."""
    rows, columns = depth.shape
    scale = 2 * np.tan(np.radians(fov) / 2) / rows
    x = (np.arange(columns) + 0.5 - columns / 2) * scale
    y = (np.arange(rows) + 0.5 - rows / 2)[:, None] * scale
    place = np.stack([x * depth, y * depth, depth], -1)
    across, down = np.gradient(place, axis=1), np.gradient(place, axis=0)
    normal = np.cross(across, down)
    normal /= np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-20)
    towards = place / np.maximum(np.linalg.norm(place, axis=-1, keepdims=True), 1e-20)
    return 255 * np.abs((normal * towards).sum(-1))


class Frame:
    """What is measured of a frame: pictures of brightness 0 to 255, where water is, and its motion in pixels."""

    def __init__(self, mi, folder, number):
        from PIL import Image

        def layers(kind):
            bitmap = mi.Bitmap(str(folder / f"{kind}.{number}.exr"))
            names = [field.name for field in bitmap.struct_()]
            data = np.array(bitmap).astype("f4")
            drawn_with = json.loads(bitmap.metadata()["whitewater"])
            return {name: data[..., i] for i, name in enumerate(names)}, json.loads(drawn_with["camera"])["fov_y_degrees"]

        water, fov = layers("w")
        self.wet = water["water.depth.Z"] < 1e9
        self.vectors = np.stack([water["motion.X"], water["motion.Y"]], -1)
        self.motion = np.hypot(water["motion.X"], water["motion.Y"])
        picture = lambda kind: np.asarray(Image.open(folder / f"{kind}.{number}.png").convert("RGB")).astype("f4") @ LUMA
        self.pictures = {"default": picture("s"), "water": picture("w")}
        for name, layer in (("particles", "water.depth.Z"), ("surface", "water.surface.Z")):
            depth = water[layer]
            self.pictures[name] = np.where(depth < 1e9, shaded(np.where(depth < 1e9, depth, 0), fov), 0)


def kinds(before, now, after):
    """Masks of the kinds of pixels of a frame between two others."""
    wet = [frame.wet for frame in (before, now, after)]
    always = wet[0] & wet[1] & wet[2]
    # Motion is since the frame before: that of `before` itself is none of ours.
    moving = (np.maximum(now.motion, after.motion) > STILL) | (wet[0] ^ wet[1]) | (wet[1] ^ wet[2])
    moving = grown(moving, NEAR)
    some = grown(wet[0] | wet[1] | wet[2], NEAR)
    return dict(zip(KINDS, [~some, always & ~moving, always & moving]))


def change(before, now, after):
    """What of a picture is not half-way between its neighbours."""
    return np.abs(now - (before + after) / 2)


def followed(before, vectors):
    """A picture moved by vectors in pixels, x right and y down, from where each pixel was; between pixels linear."""
    rows, columns = before.shape
    y, x = np.mgrid[:rows, :columns]
    x, y = (x - vectors[..., 0]).clip(0, columns - 1), (y - vectors[..., 1]).clip(0, rows - 1)
    x0, y0 = x.astype(int).clip(0, columns - 2), y.astype(int).clip(0, rows - 2)
    fx, fy = x - x0, y - y0
    top = before[y0, x0] * (1 - fx) + before[y0, x0 + 1] * fx
    low = before[y0 + 1, x0] * (1 - fx) + before[y0 + 1, x0 + 1] * fx
    return top * (1 - fy) + low * fy


def measure(frames, masks=kinds):
    """Numbers of each kind of pixels, and the maps of change of the frame that changes most in it."""
    numbers, worst = {}, {}
    rows = {kind: [] for kind in KINDS}
    for k in range(1, len(frames) - 1):
        three = frames[k - 1:k + 2]
        of_kind = masks(*three)
        changes = {name: change(*(frame.pictures[name] for frame in three)) for name in three[1].pictures}
        steps = {name: np.abs(three[1].pictures[name] - three[0].pictures[name]) for name in changes}
        left = {name: np.abs(three[1].pictures[name] - followed(three[0].pictures[name], three[1].vectors)) for name in changes}
        for kind, mask in of_kind.items():
            if mask.sum() < 200:
                continue
            step = three[1].pictures["default"] - three[0].pictures["default"]
            row = {name: float(map_[mask].mean()) for name, map_ in changes.items()}
            row |= {f"{name} deviation": float(three[1].pictures[name][mask].std()) for name in changes}
            row |= {f"{name} unexplained": float(left[name][mask].mean() / max(steps[name][mask].mean(), 1e-3)) for name in changes}
            row |= {"frame": k, "pixels": int(mask.sum()), "step": float(np.median(step[mask])),
                    "large": float((changes["default"][mask] > 16).mean())}
            rows[kind].append(row)
            if kind not in worst or row["default"] > worst[kind][0]:
                worst[kind] = (row["default"], k, changes["default"], mask)
    for kind, list_ in rows.items():
        if not list_:
            continue
        of = {key: np.array([row[key] for row in list_]) for key in list_[0]}
        relative = lambda name: float((of[name] / np.maximum(of[f"{name} deviation"], 1e-3)).mean())
        # A pop: this frame changes more, against the median frame, than its particles do.
        pops = (of["default"] / max(np.median(of["default"]), 0.1)) / np.maximum(of["surface"] / max(np.median(of["surface"]), 0.1), 1)
        top = int(np.argmax(pops))
        numbers[kind] = {
            "pixels": float(of["pixels"].mean()), "change": {name: float(of[name].mean()) for name in frames[0].pictures},
            "relative": {name: relative(name) for name in frames[0].pictures},
            "unexplained": {name: float(of[f"{name} unexplained"].mean()) for name in frames[0].pictures}, "large": float(of["large"].mean()),
            "step": float(np.abs(of["step"]).max()), "pop": float(pops[top]), "pop frame": int(of["frame"][top]), "frames": list_,
        }
    return numbers, worst


def table(results):
    head = ["sequence", "pixels", "share of the picture", "change, levels", "without foam and spray", "over 16 levels",
            "relative change: ours", "surface, shaded", "particles, shaded", "left after motion: ours",
            "without foam and spray", "surface, shaded", "particles, shaded", "largest step of the median", "largest pop (frame)"]
    rows = [head, ["---"] * len(head)]
    for name, result in results.items():
        for kind, n in result["kinds"].items():
            wet = kind != KINDS[0]
            rows.append([name, kind, f"{n['pixels'] / result['pixels']:.2f}", f"{n['change']['default']:.2f}", f"{n['change']['water']:.2f}",
                         f"{100 * n['large']:.2f} %", *(f"{n['relative'][key]:.2f}" if wet or key == "default" else "" for key in ("default", "surface", "particles")),
                         *(f"{n['unexplained'][key]:.2f}" if kind == KINDS[2] else "" for key in ("default", "water", "surface", "particles")),
                         f"{n['step']:.1f}", f"{n['pop']:.1f} ({result['numbers'][n['pop frame']]})"])
    return "".join("| " + " | ".join(row) + " |\n" for row in rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=pathlib.Path, help="folder of the caches")
    parser.add_argument("--sequences", type=pathlib.Path, default=HERE / "sequences.toml", help="which [default: sequences.toml beside this]")
    parser.add_argument("--only", action="append", help="this sequence of them; may be given several times")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder to write to")
    parser.add_argument("--whitewater", default="whitewater", help="the program [default: of the path]")
    parser.add_argument("--arguments", default="", help="more arguments of each run")
    parser.add_argument("--size", default="640x360", help="pixels [default: 640x360]")
    parser.add_argument("--table", type=pathlib.Path, help="page of results to write, Markdown, of all sequences that --out has numbers of")
    parser.add_argument("--keep", action="store_true", help="keep frames that are there")
    options = parser.parse_args()
    sequences = tomllib.loads(options.sequences.read_text())
    wanted = options.only or list(sequences)
    unknown = [name for name in wanted if name not in sequences]
    if unknown:
        parser.error(f"{options.sequences} has no sequence {', '.join(unknown)}; it has {', '.join(sequences)}")
    if not options.data and any("input" in sequences[name] for name in wanted):
        parser.error("--data is missing")
    options.out.mkdir(parents=True, exist_ok=True)

    import mitsuba as mi
    from PIL import Image

    mi.set_variant("scalar_rgb")
    stored = options.out / "flicker.json"
    results = json.loads(stored.read_text()) if stored.exists() else {}
    ran = lambda *command: subprocess.run(command, capture_output=True, text=True).stdout.split("\n")[0]
    made = (f"with {ran(options.whitewater, '--version')}, commit {ran('git', '-C', HERE, 'rev-parse', '--short', 'HEAD')}; "
            f"{options.size} pixels" + (f"; `{options.arguments}`" if options.arguments else ""))
    for name in wanted:
        folder = draw(name, sequences[name], options)
        numbers = sorted(re.fullmatch(r"s\.(.*)\.exr", path.name)[1] for path in folder.glob("s.*.exr"))
        frames = [Frame(mi, folder, number) for number in numbers]
        of_kinds, worst = measure(frames)
        for kind, (_, k, map_, mask) in worst.items():
            picture = np.asarray(Image.open(folder / f"s.{numbers[k]}.png").convert("RGB"))
            map_ = np.minimum(8 * map_, 255)
            shown = np.where(mask[..., None], map_[..., None], [0, 0, 90])
            Image.fromarray(np.concatenate([picture, shown.astype("u1")], 1)).save(options.out / f"{name}_{kind.replace(' ', '_')}.png")
        results[name] = {"kinds": of_kinds, "numbers": numbers, "pixels": frames[0].wet.size, "made": made}
        stored.write_text(json.dumps(results, indent=1))
        (options.out / "flicker.md").write_text(table(results))
        print(table({name: results[name]}), end="", flush=True)
    if options.table:
        others = "".join(f"*{name}* was measured {result.get('made', 'by an earlier version of this program')}.\n\n"
                         for name, result in results.items() if result.get("made") != made)
        options.table.write_text(
            f"# Flicker: results\n\nWritten by `flicker.py --table` on {datetime.date.today()} {made}. "
            f"[README.md](README.md#flicker) describes the columns.\n\n{others}{table(results)}")


if __name__ == "__main__":
    main()
