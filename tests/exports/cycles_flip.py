#!/usr/bin/env python3
"""Makes still scenes, draws each with Blender's path tracer and with `soffio render`, and compares the two by FLIP.

    python3 -m venv VENV && VENV/bin/pip install bpy flip-evaluator
    VENV/bin/python tests/exports/cycles_flip.py target/release/soffio OUT [scene …]

Leaves models, scenario files, both pictures and the map of differences in OUT. Ends with 1 where a mean of FLIP
(Andersson et al. 2020, 67 pixels a degree) is above its bar.
"""

import json
import math
import os
import subprocess
import sys

import bpy
import flip_evaluator
import numpy as np
from mathutils import Vector

import addon_utils  # comes with bpy

# Highest mean of FLIP: polished spheres mirror a room that image light does not know.
BARS = {"spheres": 0.08, "mobile": 0.06, "small_lamp": 0.06, "chimes": 0.09, "clock": 0.09, "wires": 0.06}
SAMPLES = 96


def paint(name, rgb, rough, metal=0.0):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    inputs = made.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value = (*rgb, 1)
    inputs["Roughness"].default_value, inputs["Metallic"].default_value = rough, metal
    return made


def put(material, smooth):
    made = bpy.context.object
    made.data.materials.append(material)
    made.data.polygons.foreach_set("use_smooth", [smooth] * len(made.data.polygons))
    return made


def box(at, size, material):
    bpy.ops.mesh.primitive_cube_add(size=1, location=at)
    put(material, False).scale = size


def ball(at, radius, material):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=radius, location=at)
    put(material, True)


def disc(at, radius, thick, material, tilt=(0, 0, 0), squeeze=1.0):
    turn = (math.pi / 2 + tilt[0], tilt[1], tilt[2])
    bpy.ops.mesh.primitive_cylinder_add(vertices=48, radius=radius, depth=thick, location=at, rotation=turn)
    put(material, False).scale = (1, squeeze, 1)


def tube(points, radius, material):
    curve = bpy.data.curves.new("tube", "CURVE")
    curve.dimensions, curve.bevel_depth, curve.bevel_resolution, curve.use_fill_caps = "3D", radius, 3, True
    line = curve.splines.new("POLY")
    line.points.add(len(points) - 1)
    for point, place in zip(line.points, points):
        point.co = (*place, 1)
    made = bpy.data.objects.new("tube", curve)
    bpy.context.collection.objects.link(made)
    bpy.ops.object.select_all(action="DESELECT")
    made.select_set(True)
    bpy.context.view_layer.objects.active = made
    bpy.ops.object.convert(target="MESH")
    put(material, True)


def room():
    box((0, 1.0, 1.2), (4, 0.05, 2.8), paint("wall", (0.8, 0.8, 0.78), 0.9))
    box((0, 0, -0.225), (4, 2.05, 0.05), paint("floor", (0.55, 0.5, 0.45), 0.6))


def spheres():
    for i in range(5):
        rough = max(i / 4, 0.05)
        ball((0.5 * i - 1, 0.2, 0.35), 0.2, paint(f"red {i}", (0.6, 0.1, 0.1), rough))
        ball((0.5 * i - 1, 0.2, 0.9), 0.2, paint(f"gold {i}", (0.9, 0.6, 0.3), rough, 1.0))
    return {"eye": [0, 0.8, 2.8], "target": [0, 0.6, 0]}


def mobile():
    steel = paint("steel", (0.5, 0.5, 0.5), 0.35, 1.0)
    colors = {"red": (0.62, 0.02, 0.02), "blue": (0.02, 0.06, 0.4), "yellow": (0.8, 0.5, 0.02), "black": (0.02,) * 3}
    paints = {name: paint(name, color, 0.35) for name, color in colors.items()}
    for x, z, left, right in ((0, 1.7, 0.55, 0.4), (0.4, 1.4, 0.3, 0.35), (0.65, 1.1, 0.2, 0.2)):
        steps = [i / 16 for i in range(17)]
        tube([(x - left + (left + right) * s, 0, z + 0.06 * math.sin(math.pi * s)) for s in steps], 0.003, steel)
    hung = [((0, 2.2), 1.75), ((0.4, 1.7), 1.45), ((0.75, 1.4), 1.15), ((-0.55, 1.7), 1.62), ((0.1, 1.4), 1.28)]
    for (x, top), foot in [*hung, ((0.45, 1.1), 1.03), ((0.85, 1.1), 1.0), ((-0.3, 1.72), 0.87)]:
        tube([(x, 0, top), (x, 0, foot)], 0.003, steel)
    disc((-0.55, 0.02, 1.5), 0.2, 0.003, paints["red"], (0.1, 0.5, 0.3), 0.7)
    disc((0.1, -0.03, 1.2), 0.14, 0.003, paints["black"], (-0.1, -0.4, -0.5), 0.6)
    disc((0.45, 0.03, 0.95), 0.11, 0.003, paints["yellow"], (0.05, 0.2, 1.2), 0.8)
    disc((0.86, 0, 0.92), 0.12, 0.003, paints["blue"], (0, -0.3, 0.2), 0.7)
    disc((-0.3, 0.1, 0.75), 0.25, 0.003, paints["blue"], (0.2, 0.1, -0.2), 0.5)
    return {}


def small_lamp():
    lamp = {"center": [1.2, 2.6, 1.8], "target": [0, 0.8, 0], "width": 0.12, "height": 0.12, "power_w": 60.0}
    return {**mobile(), "env_intensity": 0.15, "area_light": lamp}


def chimes():
    aluminium, wood = paint("aluminium", (0.75, 0.76, 0.78), 0.3, 1.0), paint("wood", (0.35, 0.18, 0.08), 0.5)
    flat = (math.pi / 2, 0, 0)
    disc((0, 0.2, 1.6), 0.25, 0.03, wood, flat)
    for i in range(6):
        x, y, long = 0.17 * math.cos(i * math.pi / 3), 0.2 + 0.17 * math.sin(i * math.pi / 3), 0.9 - 0.06 * i
        bpy.ops.mesh.primitive_cylinder_add(vertices=32, radius=0.018, depth=long, location=(x, y, 1.5 - long / 2))
        put(aluminium, True)
        tube([(x, y, 1.6), (x, y, 1.5)], 0.0008, wood)
    disc((0, 0.2, 0.85), 0.07, 0.02, wood, flat)
    tube([(0, 0.2, 1.6), (0, 0.2, 0.4)], 0.001, wood)
    disc((0, 0.2, 0.4), 0.1, 0.004, paint("sail", (0.7, 0.3, 0.1), 0.5))
    return {"eye": [0, 1.1, 2.6], "target": [0, 1.0, 0.1]}


def clock():
    dark, light = paint("dark", (0.3, 0.15, 0.07), 0.55), paint("light", (0.5, 0.33, 0.18), 0.6)
    brass = paint("brass", (0.85, 0.6, 0.25), 0.3, 1.0)
    for z in (0.6, 1.5):
        box((0, 0.5, z), (0.9, 0.4, 0.06), dark)
    for x in (-0.42, 0.42):
        box((x, 0.5, 1.05), (0.06, 0.4, 0.84), dark)
    wheels = ((-0.15, 1.1, 0.2, light), (0.16, 1.2, 0.14, light), (0.05, 0.85, 0.11, brass), (0.25, 0.95, 0.06, brass))
    for k, (x, z, radius, material) in enumerate(wheels):
        disc((x, 0.4 + 0.02 * k, z), radius, 0.02, material)
    tube([(0, 0.25, 1.45), (0.1, 0.25, 0.75)], 0.004, brass)
    disc((0.1, 0.25, 0.72), 0.06, 0.02, brass)
    for i in range(12):
        angle = i * math.pi / 6
        ball((0.15 * math.cos(angle) - 0.15, 0.33, 1.1 + 0.15 * math.sin(angle)), 0.012, brass)
    return {"eye": [0.5, 1.3, 2.2], "target": [0, 1.0, 0]}


def wires():
    black, red = paint("black", (0.03,) * 3, 0.4), paint("red", (0.6, 0.03, 0.03), 0.4)
    for i in range(12):
        tube([(0.15 * i - 0.9, 0.1 + 0.02 * i, 0.15), (0.17 * i - 0.9, 0.2, 1.5)], 0.0006 + 0.0003 * i, black)
    for i in range(4):
        disc((0.45 * i - 0.7, 0.3, 0.35), 0.15, 0.002, red, (0, 0, 0.5 * i))
    return {}


def sky(path):
    """A room's light without the room: grey all around, three soft fields."""
    high, wide = 256, 512
    v, u = np.meshgrid((np.arange(high) + 0.5) / high, (np.arange(wide) + 0.5) / wide, indexing="ij")
    up, around = np.cos(v * math.pi), (u - 0.5) * 2 * math.pi
    pixels = np.ones((high, wide, 4), np.float32)
    grey = 0.35 + 0.25 * np.clip(up, 0, 1) - 0.15 * np.clip(-up, 0, 1)
    pixels[..., :3] = grey[..., None] * np.array([1, 0.97, 0.92])
    for at, height, half, half_up, light in ((0.6, 0.55, 0.35, 0.18, 9), (-1.8, 0.5, 0.5, 0.15, 6), (2.6, 0.2, 0.25, 0.3, 4)):
        off = np.abs((around - at + math.pi) % (2 * math.pi) - math.pi)
        soft = lambda x: 1 / (1 + np.exp(40 * x))
        field = soft(off - half) * soft(np.abs(up - height) - half_up)
        pixels[..., :3] += light * field[..., None] * np.array([1, 0.98, 0.95])
    image = bpy.data.images.new("sky", wide, high, float_buffer=True)
    image.pixels.foreach_set(pixels[::-1].ravel())
    image.filepath_raw, image.file_format = path, "HDR"
    image.save()


def make(build, out):
    """Writes the model and its scenario, and returns the scenario."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    sky(f"{out}/sky.hdr")
    room()
    lamp = {"center": [1.2, 2.6, 1.8], "target": [0, 0.8, 0], "width": 0.4, "height": 0.4, "power_w": 40.0}
    name = build.__name__
    scenario = {"model": f"{name}.glb", "width": 640, "height": 400, "eye": [0, 1.1, 3.4], "target": [0, 0.9, 0]}
    scenario |= {"fovy_deg": 35, "env": "sky.hdr", "env_intensity": 0.6, "background_linear": [0.5, 0.5, 0.5]}
    scenario |= {"area_light": lamp, "tonemap": "khronos_pbr_neutral", "exposure": 1.0} | build()
    bpy.ops.export_scene.gltf(filepath=f"{out}/{name}.glb", export_yup=True, export_apply=True)
    with open(f"{out}/{name}.json", "w", encoding="utf-8") as file:
        json.dump(scenario, file, indent=1)
    return scenario


def aimed(data, eye, target):
    made = bpy.data.objects.new("aimed", data)
    bpy.context.collection.objects.link(made)
    eye, target = ((Vector((p[0], -p[2], p[1]))) for p in (eye, target))
    made.location, made.rotation_euler = eye, (target - eye).to_track_quat("-Z", "Y").to_euler()
    return made


def trace(scenario, folder):
    """The scenario drawn by Cycles: linear RGB, rows from the top."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("cycles")
    bpy.ops.import_scene.gltf(filepath=os.path.join(folder, scenario["model"]))
    scene = bpy.context.scene
    scene.render.engine, scene.render.film_transparent = "CYCLES", True
    scene.cycles.device, scene.cycles.samples, scene.cycles.use_denoising = "CPU", SAMPLES, True
    scene.cycles.max_bounces = scene.cycles.diffuse_bounces = scene.cycles.glossy_bounces = 8
    scene.render.resolution_x, scene.render.resolution_y = scenario["width"], scenario["height"]
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.angle, camera.clip_start = "VERTICAL", math.radians(scenario["fovy_deg"]), 0.01
    scene.camera = aimed(camera, scenario["eye"], scenario["target"])
    area = scenario["area_light"]
    lamp = bpy.data.lights.new("lamp", "AREA")
    lamp.shape, lamp.size, lamp.size_y, lamp.energy = "RECTANGLE", area["width"], area["height"], area["power_w"]
    aimed(lamp, area["center"], area["target"]).visible_camera = False
    world = scene.world = bpy.data.worlds.new("world")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Strength"].default_value = scenario["env_intensity"]
    image = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    image.image = bpy.data.images.load(os.path.abspath(os.path.join(folder, scenario["env"])))
    world.node_tree.links.new(image.outputs[0], background.inputs[0])
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth, settings.color_mode = "OPEN_EXR", "32", "RGBA"
    scene.render.filepath = os.path.abspath(os.path.join(folder, "traced.exr"))
    bpy.ops.render.render(write_still=True)
    rgba = pixels_of(scene.render.filepath)
    return rgba[..., :3] + (1 - rgba[..., 3:]) * np.array(scenario["background_linear"])


def pixels_of(path):
    image = bpy.data.images.load(path)
    wide, high = image.size
    pixels = np.empty(wide * high * 4, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(high, wide, 4)[::-1]


def display(rgb):
    """Khronos PBR Neutral (specification of 2024), then sRGB."""
    low = rgb.min(-1, keepdims=True)
    rgb = rgb - np.where(low < 0.08, low - 6.25 * low * low, 0.04)
    peak = rgb.max(-1, keepdims=True)
    pressed = 1 - 0.24 * 0.24 / (peak + 0.24 - 0.76)
    pale = 1 - 1 / (0.15 * (peak - pressed) + 1)
    rgb = np.where(peak < 0.76, rgb, rgb * pressed / np.maximum(peak, 1e-9) * (1 - pale) + pressed * pale)
    rgb = np.clip(rgb, 0, 1)
    return np.where(rgb <= 0.0031308, 12.92 * rgb, 1.055 * rgb ** (1 / 2.4) - 0.055)


def save(rgb, path):
    high, wide, _ = rgb.shape
    image = bpy.data.images.new("picture", wide, high)
    image.colorspace_settings.name = "Non-Color"
    rgba = np.ones((high, wide, 4), np.float32)
    rgba[..., :3] = np.round(rgb * 255) / 255
    image.pixels.foreach_set(rgba[::-1].ravel())
    image.filepath_raw, image.file_format = path, "PNG"
    image.save()


def main(soffio, out, *chosen):
    os.makedirs(out, exist_ok=True)
    bad = 0
    for build in (spheres, mobile, small_lamp, chimes, clock, wires):
        name = build.__name__
        if chosen and name not in chosen:
            continue
        scenario = make(build, out)
        reference, drawn = f"{out}/{name}.traced.png", f"{out}/{name}.png"
        save(display(trace(scenario, out)), reference)
        subprocess.run([soffio, "render", "--scene", f"{out}/{name}.json", "-o", drawn], check=True)
        differences, mean, _ = flip_evaluator.evaluate(reference, drawn, "LDR")
        save(differences, f"{out}/{name}.flip.png")
        bad += mean > BARS[name]
        print(f"{name}: FLIP {mean:.4f}, at most {BARS[name]}{': BAD' if mean > BARS[name] else ''}", flush=True)
    return 1 if bad else 0


sys.exit(main(*sys.argv[1:]))
