"""The path-traced picture: splashsurf's surface of the particles, in Mitsuba."""
import numpy as np

import scene


def surface(points, radius):
    """Mesh of the water (Löschner et al., Weighted Laplacian Smoothing for Surface Reconstruction of Particle-based
    Fluids, 2023): cubes of half a radius, smoothed 25 times."""
    import pysplashsurf

    result = pysplashsurf.reconstruction_pipeline(
        points, particle_radius=radius, smoothing_length=2.0, cube_size=0.5, iso_surface_threshold=0.6,
        mesh_smoothing_iters=25, mesh_smoothing_weights=True, mesh_cleanup=True, decimate_barnacles=True,
        compute_normals=True, normals_smoothing_iters=10)
    result = result[0] if isinstance(result, tuple) else result
    positions = np.asarray(result.mesh.vertices, "f4")
    triangles = np.asarray(result.mesh.triangles, "u4")
    normals = np.asarray(result.point_attributes["normals"], "f4")
    return scene.Mesh(positions, normals, np.zeros((len(positions), 2)), triangles, None)


def _ply(mi, mesh, path):
    made = mi.Mesh("mesh", len(mesh.positions), len(mesh.triangles), has_vertex_normals=True, has_vertex_texcoords=True)
    parts = mi.traverse(made)
    parts["vertex_positions"], parts["vertex_normals"] = mesh.positions.ravel(), mesh.normals.ravel()
    parts["vertex_texcoords"], parts["faces"] = mesh.places.ravel(), mesh.triangles.ravel()
    parts.update()
    made.write_ply(str(path))
    return {"type": "ply", "filename": str(path)}


def path_traced(mi, frame, meshes, water, work, options):
    """Linear light, (rows, columns, 3), and where the water is first met by a ray."""
    transform = mi.ScalarTransform4f
    dry = {
        "type": "scene",
        "sensor": {
            "type": "perspective", "fov": frame["fov"], "fov_axis": "y", "near_clip": 0.01, "far_clip": 1000.0,
            "to_world": transform().look_at(origin=frame["eye"], target=frame["target"], up=[0, 1, 0]),
            "film": {"type": "hdrfilm", "width": options.size[0], "height": options.size[1], "rfilter": {"type": "box"}, "pixel_format": "rgb"},
            "sampler": {"type": "independent", "sample_count": options.spp},
        },
        "light": {"type": "envmap", "filename": str(work / "environment.hdr"), "to_world": transform().rotate([0, 1, 0], 180)},
    }
    texture = {"type": "bitmap", "bitmap": mi.Bitmap(scene.tiles()), "raw": False, "wrap_mode": "repeat"}
    for i, mesh in enumerate(meshes):
        albedo = texture if mesh.color is None else {"type": "rgb", "value": list(mesh.color)}
        matte = {"type": "twosided", "inner": {"type": "diffuse", "reflectance": albedo}}
        dry[f"part{i}"] = _ply(mi, mesh, work / f"part{i}.ply") | {"bsdf": matte}
    absorption, scattering = (np.array(frame["medium"][key]) for key in ("absorption", "scattering"))
    extinction = absorption + scattering
    inside = {
        "type": "homogeneous", "scale": float(extinction.max()),
        "sigma_t": {"type": "rgb", "value": (extinction / extinction.max()).tolist()},
        "albedo": {"type": "rgb", "value": (scattering / extinction).tolist()},
    }
    glass = {"type": "dielectric", "int_ior": 1.333, "ext_ior": 1.0}
    wet = dry | {"water": _ply(mi, water, work / "water.ply") | {"bsdf": glass, "interior": inside}}
    dry, wet = mi.load_dict(dry), mi.load_dict(wet)

    # What a ray meets first, with the water and without.
    first = mi.load_dict({"type": "aov", "aovs": "depth:depth,normal:sh_normal,albedo:albedo"})
    without, with_water = (np.array(mi.render(s, integrator=first, spp=16)) for s in (dry, wet))
    mask = np.abs(without[..., 0] - with_water[..., 0]) > 1e-3 * np.maximum(without[..., 0], 0.1)

    integrator = mi.load_dict({"type": "volpath", "max_depth": 24, "rr_depth": 12})
    total, rounds = 0, max(1, options.spp // 16)
    for seed in range(rounds):
        sample = np.array(mi.render(wet, integrator=integrator, spp=min(16, options.spp), seed=seed))
        total = total + np.nan_to_num(sample, nan=0.0, posinf=0.0)
    picture = (total / rounds).astype("f4")[..., :3]
    if options.denoise:
        import mitsuba_oidn

        guides = {"albedo": with_water[..., 4:7].clip(0, 1), "normal": with_water[..., 1:4]}
        guides = {key: np.ascontiguousarray(value.astype("f4")) for key, value in guides.items()}
        picture = np.array(mitsuba_oidn.denoise(np.ascontiguousarray(picture), hdr=True, **guides))
    return picture[..., :3], mask
