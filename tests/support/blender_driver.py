"""Run by Blender: install the zip of the add-on, import files into scenes, tell what came.

Arguments behind ``--``: the zip, a file of jobs (JSON) and the file for the answers.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import bpy
import numpy as np

np.bool = bool  # Debian's Blender 3.4 imports glTF by it, and its NumPy has it no more


def install(path):
    """Install and enable the add-on as a user does."""
    if bpy.app.version >= (4, 2, 0):
        bpy.ops.extensions.package_install_files(
            filepath=path, repo="user_default", enable_on_install=True
        )
    else:
        bpy.ops.preferences.addon_install(filepath=path)
        bpy.ops.preferences.addon_enable(module="tinsmith")


NATIVE = {
    ".glb": ("import_scene.gltf",),
    ".obj": ("wm.obj_import",),
    ".ply": ("wm.ply_import", "import_mesh.ply"),
    ".stl": ("wm.stl_import", "import_mesh.stl"),
}
"""Blender's own importers, the newer ones first."""

Z_UP = {"forward_axis": "Y", "up_axis": "Z"}
"""What docs/meshes.md says to choose: OBJ names no axis, and Blender takes Y to be up."""


def import_natively(path):
    """Import a file by Blender's own importer, and tell the mesh that came, in the world."""
    bpy.ops.scene.new(type="NEW")
    for name in NATIVE[Path(path).suffix]:
        group, operator = name.split(".")
        run = getattr(getattr(bpy.ops, group), operator)
        try:
            run.get_rna_type()
        except KeyError:
            continue
        run(filepath=path, **(Z_UP if operator == "obj_import" else {}))
        break
    (one,) = [one for one in bpy.context.scene.objects if one.type == "MESH"]
    mesh = one.data
    images = [
        [node.image.size[0], node.image.size[1]]
        for material in mesh.materials
        if material is not None and material.use_nodes
        for node in material.node_tree.nodes
        if node.type == "TEX_IMAGE" and node.image is not None
    ]
    told = {
        "vertices": [list(one.matrix_world @ vertex.co) for vertex in mesh.vertices],
        "triangles": [list(face.vertices) for face in mesh.polygons],
        "least_area": min(face.area for face in mesh.polygons),
        "normals_up": sum((one.matrix_world.to_3x3() @ f.normal).z > 0 for f in mesh.polygons),
        "images": images,
        "uv": [list(item.uv) for layer in mesh.uv_layers for item in layer.data],
        "corners": [loop.vertex_index for loop in mesh.loops],
        "colors": [one.name for one in mesh.color_attributes],
        "materials": len(mesh.materials),
    }
    told["is_changed"] = mesh.validate()
    return told


def run_job(job):
    """Import files into a new scene, one after the other."""
    bpy.ops.scene.new(type="NEW")
    scene = bpy.context.scene
    scene.unit_settings.scale_length = job.get("scale_length", 1.0)
    answers = []
    for options in job["imports"]:
        before = set(scene.objects)
        answer = {"error": None}
        try:
            answer["result"] = sorted(bpy.ops.import_scene.tinsmith(**options))
        except RuntimeError as error:
            answer["error"] = str(error)
        new = [one for one in scene.objects if one not in before]
        answer["objects"] = [describe(one) for one in new]
        answers.append(answer)
    if "picture" in job:
        render(scene, job["picture"])
    return {"imports": answers, "scene": list_properties(scene)}


def list_properties(owner):
    return {
        key: value if isinstance(value, (str, int, float)) else list(value)
        for key, value in owner.items()
        if key.startswith("tinsmith_")
    }


def describe(one):
    """Return what can be told of an object."""
    told = {"name": one.name, "type": one.type, "properties": list_properties(one)}
    if one.type == "MESH":
        mesh = one.data
        colors = mesh.color_attributes["Elevation"].data
        told["vertices"] = [list(vertex.co) for vertex in mesh.vertices]
        told["triangles"] = [list(face.vertices) for face in mesh.polygons]
        told["edges"] = len(mesh.edges)
        told["colors"] = [list(item.color) for item in colors]
        told["is_changed"] = mesh.validate()
        told["normals_up"] = sum(face.normal.z > 0 for face in mesh.polygons)
    else:
        told["splines"] = [
            {"points": [list(p.co)[:3] for p in spline.points], "closed": spline.use_cyclic_u}
            for spline in one.data.splines
        ]
        told["bevel"] = one.data.bevel_depth
    told["materials"] = [material.name for material in one.data.materials]
    return told


def render(scene, path):
    """Render the scene from the south, above."""
    corners = [
        vertex.co for one in scene.objects if one.type == "MESH" for vertex in one.data.vertices
    ]
    wide = max(c.x for c in corners) - min(c.x for c in corners)
    middle = sum(c.z for c in corners) / len(corners)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = (0, -0.75 * wide, middle + 0.6 * wide)
    camera.rotation_euler = (0.9, 0, 0)
    camera.data.clip_end = 10 * wide
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy = 2.0
    sun.rotation_euler = (0.9, 0.2, 2.5)
    for one in (camera, sun):
        scene.collection.objects.link(one)
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 16
    scene.cycles.device, scene.cycles.use_denoising = "CPU", False
    scene.render.resolution_x, scene.render.resolution_y = 900, 560
    scene.view_settings.view_transform = "Standard"
    scene.world = bpy.data.worlds.new("world")
    scene.world.color = (0.8, 0.85, 0.95)
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)


def main():
    packed, jobs, answers = sys.argv[sys.argv.index("--") + 1 :]
    install(packed)
    wanted = json.loads(Path(jobs).read_text())
    natively = {name: import_natively(path) for name, path in wanted.pop("native", {}).items()}
    told = {name: run_job(job) for name, job in wanted.items()}
    told["native"] = natively
    bpy.ops.preferences.addon_disable(module=find_module())
    told["left"] = hasattr(bpy.types, "IMPORT_SCENE_OT_tinsmith")
    told["version"] = list(bpy.app.version)
    Path(answers).write_text(json.dumps(told))


def find_module():
    """Return the name of the add-on among those that are enabled."""
    names = [one.module for one in bpy.context.preferences.addons]
    return next(name for name in names if "tinsmith" in name)


main()
