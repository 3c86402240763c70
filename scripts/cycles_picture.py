"""What Blender runs for scripts/cycles-picture: a mesh file and a run's camera to a picture by Cycles.

Light is that of render/light/environment.h and render/frame/frame.h.
"""
import json
import math
import sys

import bpy
import mathutils
import numpy

numpy.bool = bool  # which Blender 3.4's glTF reader still asks of Debian's NumPy

mesh_file, record_file, size, samples, picture_file = sys.argv[sys.argv.index("--") + 1:]
width, height = (int(side) for side in size.split("x"))
with open(record_file, encoding="utf-8") as file:
    camera_of_run = json.load(file)["camera"]

SUN = (0.95, 0.90, 0.80)
ZENITH = (0.36, 0.42, 0.53)
HORIZON = (0.58, 0.60, 0.63)
GROUND = (0.39, 0.38, 0.36)  # under sun and sky it shows the radiance of the environment's floor
SUN_DIRECTION = mathutils.Vector((-0.45, 0.35, -0.82))


def colour(rgb):
    return (*rgb, 1.0)


def add_bodies():
    bpy.ops.import_scene.gltf(filepath=mesh_file)
    for body in [one for one in bpy.context.scene.objects if one.type == "MESH"]:
        if len(body.data.vertices) > 8:
            body.modifiers.new("rounded", "SUBSURF").render_levels = 2
            for polygon in body.data.polygons:
                polygon.use_smooth = True


def add_ground():
    bpy.ops.mesh.primitive_plane_add(size=2000.0)
    material = bpy.data.materials.new("ground")
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = colour(GROUND)
    shader.inputs["Roughness"].default_value = 1.0
    bpy.context.object.data.materials.append(material)


def add_sun():
    light = bpy.data.lights.new("sun", "SUN")
    light.energy = math.pi * max(SUN)  # W/m^2: a white, matt surface that faces it then shows its radiance
    light.color = tuple(part / max(SUN) for part in SUN)
    light.angle = math.radians(2.0)
    sun = bpy.data.objects.new("sun", light)
    sun.rotation_euler = SUN_DIRECTION.to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(sun)


def add_sky():
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    where = nodes.new("ShaderNodeTexCoord")
    parts = nodes.new("ShaderNodeSeparateXYZ")
    ramp = nodes.new("ShaderNodeValToRGB")
    ramp.color_ramp.elements[0].color = colour(HORIZON)
    ramp.color_ramp.elements[1].color = colour(ZENITH)
    # z (2 - z), in four straight pieces.
    for z in (0.25, 0.5, 0.75):
        part = z * (2.0 - z)
        mixed = [a + (b - a) * part for a, b in zip(HORIZON, ZENITH)]
        ramp.color_ramp.elements.new(z).color = colour(mixed)
    links.new(where.outputs["Generated"], parts.inputs[0])
    links.new(parts.outputs["Z"], ramp.inputs["Fac"])
    links.new(ramp.outputs["Color"], nodes["Background"].inputs["Color"])
    bpy.context.scene.world = world


def add_camera():
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle = math.radians(camera_of_run["field_of_view"])
    camera.clip_end = 10000.0
    placed = bpy.data.objects.new("camera", camera)
    eye, target = (mathutils.Vector(camera_of_run[name]) for name in ("eye", "target"))
    placed.location = eye
    placed.rotation_euler = (target - eye).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(placed)
    bpy.context.scene.camera = placed


for old in list(bpy.data.objects):
    bpy.data.objects.remove(old)
add_bodies()
add_ground()
add_sun()
add_sky()
add_camera()
scene = bpy.context.scene
scene.render.engine = "CYCLES"
scene.cycles.samples = int(samples)
scene.cycles.use_denoising = False
scene.view_settings.view_transform = "Standard"
scene.render.resolution_x, scene.render.resolution_y = width, height
scene.render.resolution_percentage = 100
scene.render.filepath = picture_file
bpy.ops.render.render(write_still=True)
