#!/usr/bin/env python3
"""Compares `whitewater render` with a path-traced picture of the same particles, basin, camera and light.

  compare.py --data DIR [--frames FILE.toml] [--only NAME]... [--variant NAME=ARGUMENTS]... --out DIR [--table FILE.md]

FILE.toml says which frames, README.md how. Writes to DIR the pictures (NAME_reference.png, NAME_VARIANT.png), one
beside the other (NAME.png), all numbers (numbers.json) and a table (table.md); to FILE.md a page of results. A
path-traced picture is kept in DIR/work, and drawn again if its particles, scene, light, size or samples change.
"""
import argparse
import datetime
import hashlib
import importlib.metadata
import json
import pathlib
import shlex
import subprocess
import sys
import time
import tomllib

import numpy as np

import particles
import reference
import scene
from scene import LUMINANCE, to_srgb

POOL = {"absorption": [1.1, 0.24, 0.11], "scattering": [0.014, 0.03, 0.04]}
"""`Medium::POOL`; both programs are told."""

DEFAULTS = {"fov": 42.0, "medium": POOL, "solids": [], "walls": None, "sun": None, "scale": 1.0, "up": "y"}
"""Of a frame's table."""

HERE = pathlib.Path(__file__).parent


def draw(mi, frame, cache, work, arguments, options):
    """Our picture, linear light, where it has water, and the seconds that the whole program took."""
    picture = work / "whitewater.exr"
    picture.unlink(missing_ok=True)
    command = [
        options.whitewater, "render", str(cache), "--radius", str(frame["radius"]), "--scene", str(work / "scene.glb"),
        "--camera", str(work / "camera.json"), "--environment", str(work / "environment.hdr"),
        "--settings", str(work / "settings.toml"), "--size", "{}x{}".format(*options.size), "--overwrite",
        "--up-axis", frame["up"], "--scale", str(frame["scale"]),
        "-o", str(picture), *shlex.split(arguments),
    ]
    began = time.monotonic()
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode:
        sys.exit(f"compare: {shlex.join(command)} failed: {run.stderr.strip()}")
    bitmap = mi.Bitmap(str(picture))
    channels = {field.name: i for i, field in enumerate(bitmap.struct_())}
    data = np.array(bitmap)
    light = np.stack([data[..., channels[name]] for name in "RGB"], -1).astype("f4")
    return light, data[..., channels["water.depth.Z"]] < 1e9, time.monotonic() - began


def versions():
    """Of what draws the path-traced picture."""
    return {name: importlib.metadata.version(name) for name in ("mitsuba", "pysplashsurf")}


def signature(files, points, settings):
    """Tells whether a kept picture was drawn from the same files, particles and settings."""
    made = hashlib.sha256(json.dumps(settings).encode())
    for data in [file.read_bytes() for file in files] + [points.astype("f4").tobytes()]:
        made.update(hashlib.sha256(data).digest())
    return made.hexdigest()


def measure(truth, ours, mask):
    """Over pixels of a mask, of exposed linear light: FLIP of what a screen shows, mean and deviation of luminance."""
    import flip_evaluator

    shown = [to_srgb(picture).astype("f4") for picture in (truth, ours)]
    error, *_ = flip_evaluator.evaluate(*shown, "LDR", applyMagma=False)
    error = np.asarray(error).reshape(*mask.shape, -1)[..., 0]
    luminance = [np.minimum(picture[mask] @ LUMINANCE, 2.0) for picture in (truth, ours)]
    return {
        "flip": float(error[mask].mean()),
        "mean": [float(l.mean()) for l in luminance],
        "deviation": [float(l.std()) for l in luminance],
    }


def save(path, linear):
    from PIL import Image

    Image.fromarray((255 * to_srgb(linear) + 0.5).astype("u1")).save(path)


def compare(mi, name, frame, options):
    """The numbers of each variant of a frame."""
    frame = DEFAULTS | frame
    work = options.out / "work" / name
    work.mkdir(parents=True, exist_ok=True)
    kept = work / "reference.npz"
    cache = frame["cache"]
    if isinstance(cache, dict):
        cache = work / "particles.npy"
        np.save(cache, particles.pool(frame["radius"], frame["box"], **frame["cache"]).astype("f4"))
    else:
        cache = options.data / cache
    points = particles.read(cache, frame["scale"], frame["up"])
    meshes = scene.basin(points, frame["radius"], frame["box"], frame["eye"], frame["walls"])
    meshes += [scene.solid(**solid) for solid in frame["solids"]]
    scene.write_glb(meshes, work / "scene.glb")
    camera = {"eye": frame["eye"], "target": frame["target"], "up": [0, 1, 0], "fov_y_degrees": frame["fov"]}
    (work / "camera.json").write_text(json.dumps(camera))
    medium = ", ".join(f"{key} = {value}" for key, value in frame["medium"].items())
    (work / "settings.toml").write_text(f"[water]\nmedium = {{{medium}}}\n")
    white = scene.environment(mi, options.data / frame["environment"], frame["sun"], work / "environment.hdr")
    drawn_from = signature([work / file for file in ("scene.glb", "camera.json", "settings.toml", "environment.hdr")], points,
                           [frame["radius"], options.size, options.spp, options.denoise, options.mitsuba, versions()])
    if not kept.exists() or str(np.load(kept).get("signature")) != drawn_from:
        water = reference.surface(points, frame["radius"])
        began = time.monotonic()
        picture, mask = reference.path_traced(mi, frame, meshes, water, work, options)
        np.savez(kept, picture=picture, mask=mask, white=white, seconds=time.monotonic() - began, signature=drawn_from)
    stored = np.load(kept)
    # One exposure for both, a little over white level ground; no curve.
    exposure = 0.9 / float(stored["white"])
    truth, wet = stored["picture"] * exposure, stored["mask"]
    save(options.out / f"{name}_reference.png", truth)
    shown, numbers = [truth], {}
    for variant, arguments in options.variant:
        light, water, seconds = draw(mi, frame, cache, work, arguments, options)
        light = light * exposure
        save(options.out / f"{name}_{variant}.png", light)
        shown.append(light)
        either = wet | water
        numbers[variant] = measure(truth, light, either) | {
            "dry": measure(truth, light, ~either), "pixels": int(either.sum()), "lost": int((wet & ~water).sum()),
            "extra": int((water & ~wet).sum()), "seconds": seconds, "path_traced_seconds": float(stored["seconds"]), "made": options.made,
        }
    save(options.out / f"{name}.png", np.concatenate(shown, 1))
    return numbers


def table(results):
    """Markdown: a row a frame and variant, and the means."""
    head = ["frame", "variant", "FLIP", "mean light, ours over the path-traced", "contrast, the same", "water lost, extra (pixels)", "dry FLIP"]
    rows = [head, ["---"] * len(head)]
    for variant in dict.fromkeys(v for numbers in results.values() for v in numbers):
        of_variant = [(name, numbers[variant]) for name, numbers in results.items() if variant in numbers]
        ratio = lambda n, key: n[key][1] / max(n[key][0], 1e-9)
        for name, n in of_variant:
            rows.append([name, variant, f"{n['flip']:.3f}", f"{ratio(n, 'mean'):.2f}", f"{ratio(n, 'deviation'):.2f}",
                         f"{n['lost']}, {n['extra']} of {n['pixels']}", f"{n['dry']['flip']:.3f}"])
        mean = np.mean([n["flip"] for _, n in of_variant])
        rows.append([f"mean of {len(of_variant)}", variant, f"{mean:.3f}", "", "", "", ""])
    return "".join("| " + " | ".join(row) + " |\n" for row in rows)


def page(results, frames, options):
    """Markdown: what was drawn with what, and a row a frame: FLIP, mean light and contrast of the path-traced picture and
    of each variant, beside the first such numbers (`first` of a frame)."""
    variants = [name for name, _ in options.variant]
    names = [name for name in frames if all(variant in results.get(name, {}) for variant in variants)]
    lines = [
        "# Frames beside a path tracer: results", "",
        f"Written by `compare.py --table` on {datetime.date.today()} {options.made}. "
        "[README.md](README.md) describes the columns' quantities and the limits of the path-traced picture. "
        "Light and contrast are those of exposed linear light (1 is white).", "",
        "Variants: " + "; ".join(f"*{name}*" + (f" is `{arguments}`" if arguments else " has no arguments") for name, arguments in options.variant) + ".", "",
    ]
    for name, v in ((name, v) for name in names for v in variants):
        made = results[name][v].get("made", "by an earlier version of this program")
        lines += [f"*{name}*, variant *{v}*, was drawn {made}.", ""] if made != options.made else []
    head = ["frame", "of", *(f"FLIP, {v}" for v in variants), "mean light, path-traced", *(v for v in variants),
            "contrast, path-traced", *(v for v in variants), f"FLIP at first, {variants[0]}"]
    rows = [head, ["---"] * 2 + ["---:"] * (len(head) - 2)]
    for name in names:
        numbers, first = results[name], frames[name].get("first")
        cells = [name, frames[name]["of"], *(f"{numbers[v]['flip']:.3f}" for v in variants)]
        for key in ("mean", "deviation"):
            cells += [f"{numbers[variants[0]][key][0]:.3f}", *(f"{numbers[v][key][1]:.3f}" for v in variants)]
        rows.append(cells + [f"{first['flip']:.3f}" if first else ""])
    mean = lambda of: f"{np.mean([of(results[name]) for name in names]):.3f}"
    rows.append([f"mean of {len(names)}", "", *(mean(lambda n, v=v: n[v]["flip"]) for v in variants), *[""] * (len(head) - 2 - len(variants))])
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    ratio = lambda n, v, key: n[v][key][1] / max(n[v][key][0], 1e-9)
    lines += ["", "Ours over the path-traced:", ""]
    head = ["frame", *(f"light, {v}" for v in variants), *(f"contrast, {v}" for v in variants), "light at first", "water lost, extra (share of its pixels)", "FLIP beside the water"]
    rows = [head, ["---"] + ["---:"] * (len(head) - 1)]
    for name in names:
        n, first = results[name], frames[name].get("first")
        v = variants[0]
        rows.append([name, *(f"{ratio(n, v, key):.2f}" for key in ("mean", "deviation") for v in variants), f"{first['light']:.2f}" if first else "",
                     f"{n[v]['lost'] / n[v]['pixels']:.3f}, {n[v]['extra'] / n[v]['pixels']:.3f}", f"{n[v]['dry']['flip']:.3f}"])
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=pathlib.Path, required=True, help="folder of the caches and environments")
    parser.add_argument("--frames", type=pathlib.Path, default=HERE / "frames.toml", help="which frames [default: frames.toml beside this]")
    parser.add_argument("--only", action="append", help="this frame of them; may be given several times")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder to write to")
    parser.add_argument("--table", type=pathlib.Path, help="page of results to write, Markdown, of all frames that --out has numbers of")
    parser.add_argument("--variant", action="append", help="NAME=ARGUMENTS: a run of whitewater with these arguments "
                        "[default: 'water=--surface-foam none --spray none' and 'default=']")
    parser.add_argument("--whitewater", default="whitewater", help="the program [default: of the path]")
    parser.add_argument("--size", type=lambda text: [int(n) for n in text.split("x")], default=[640, 360], help="pixels [default: 640x360]")
    parser.add_argument("--spp", type=int, default=96, help="paths a pixel [default: 96]")
    parser.add_argument("--no-denoise", dest="denoise", action="store_false", help="leave the noise in")
    parser.add_argument("--mitsuba", default="llvm_ad_rgb", help="Mitsuba's variant [default: llvm_ad_rgb]")
    options = parser.parse_args()
    if len(options.size) != 2 or min(options.size) < 1:
        parser.error("--size: WIDTHxHEIGHT expected")
    if options.spp < 1 or options.spp > 16 and options.spp % 16:
        parser.error("--spp: up to 16, or a multiple of 16")
    if any("=" not in text for text in options.variant or []):
        parser.error("--variant: NAME=ARGUMENTS expected")
    options.variant = [text.split("=", 1) for text in options.variant or ["water=--surface-foam none --spray none", "default="]]
    frames = tomllib.loads(options.frames.read_text())
    wanted = options.only or list(frames)
    unknown = [name for name in wanted if name not in frames]
    if unknown:
        parser.error(f"{options.frames} has no frame {', '.join(unknown)}; it has {', '.join(frames)}")
    options.out.mkdir(parents=True, exist_ok=True)

    import mitsuba as mi

    mi.set_variant(options.mitsuba)
    mi.set_log_level(mi.LogLevel.Error)
    program = subprocess.run([options.whitewater, "--version"], capture_output=True, text=True).stdout.split("\n")[0]
    commit = subprocess.run(["git", "-C", HERE, "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    options.made = (f"with {program}, commit {commit or 'unknown'}; {', '.join(f'{k} {v}' for k, v in versions().items())}, "
                    f"{options.spp} paths per pixel{', denoised' if options.denoise else ''}; {'x'.join(map(str, options.size))} pixels")
    stored = options.out / "numbers.json"
    results = json.loads(stored.read_text()) if stored.exists() else {}
    for name in wanted:
        results[name] = compare(mi, name, frames[name], options)
        stored.write_text(json.dumps(results, indent=1))
        (options.out / "table.md").write_text(table(results))
        print(table({name: results[name]}), end="", flush=True)
    if options.table:
        options.table.write_text(page(results, frames, options))


if __name__ == "__main__":
    main()
