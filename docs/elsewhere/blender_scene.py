# SPDX-License-Identifier: Apache-2.0
"""A grass set in Blender: texgen export SET -o DIR --for blender, then
    blender --background --python blender_scene.py -- DIR picture.png [SAMPLES]
or, with bpy from PyPI, python blender_scene.py DIR picture.png [SAMPLES].
Left, the blades as a mesh with their colours; right, volume.vdb with a material that shows it:
density as extinction, and the grid
`colour` as albedo."""

import json
import math
import sys
from pathlib import Path

import bpy

arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
folder, picture = Path(arguments[0]).resolve(), Path(arguments[1]).resolve()
samples = int(arguments[2]) if len(arguments) > 2 else 32
facts = json.loads((folder / "export.json").read_text())
side, canopy = facts["side_m"], facts["canopy_m"]
VOXEL_M = side / 256  # of a set with 256 texels a side: volume.vdb has voxels as wide as a texel

bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene


def material(name):
    """An empty material; its nodes and links."""
    new = bpy.data.materials.new(name)
    new.use_nodes = True
    nodes, links = new.node_tree.nodes, new.node_tree.links
    nodes.clear()
    return new, nodes, links


def import_mesh():
    """Variant 0 with one material: COLOR_0 is linear albedo."""
    bpy.ops.import_scene.gltf(filepath=str(folder / "blades_mesh.glb"))
    grass, nodes, links = material("grass")
    colour, surface, out = (
        nodes.new("ShaderNodeVertexColor"),
        nodes.new("ShaderNodeBsdfDiffuse"),
        nodes.new("ShaderNodeOutputMaterial"),
    )
    through, mix = nodes.new("ShaderNodeBsdfTranslucent"), nodes.new("ShaderNodeMixShader")
    mix.inputs[0].default_value = 0.3
    links.new(colour.outputs["Color"], surface.inputs["Color"])
    links.new(colour.outputs["Color"], through.inputs["Color"])
    links.new(surface.outputs[0], mix.inputs[1])
    links.new(through.outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], out.inputs["Surface"])
    for thing in [o for o in bpy.data.objects if o.type == "MESH"]:
        if not thing.name.startswith("variant0_"):
            bpy.data.objects.remove(thing)
            continue
        colour.layer_name = thing.data.color_attributes[0].name
        thing.data.materials.clear()
        thing.data.materials.append(grass)
        print(
            thing.name,
            len(thing.data.vertices),
            "vertices,",
            [a.name for a in thing.data.attributes if a.name.startswith("_")],
        )


def import_volume():
    """The file is y up: turned about x, as the glTF importer turns meshes. Its own frame begins at
    the patch's corner."""
    data = bpy.data.volumes.new("volume")
    data.filepath = str(folder / "volume.vdb")
    thing = bpy.data.objects.new("volume", data)
    scene.collection.objects.link(thing)
    thing.rotation_euler = (math.pi / 2, 0, 0)
    thing.location = (side * 1.1, 0, 0)
    data.grids.load()
    print("grids:", [g.name for g in data.grids])
    fog, nodes, links = material("fog")
    density, colour = nodes.new("ShaderNodeAttribute"), nodes.new("ShaderNodeAttribute")
    density.attribute_name, colour.attribute_name = "density", "colour"
    # Density is area over the face of a voxel; a ray sees half of the area of leaves that point
    # every way.
    extinction = nodes.new("ShaderNodeMath")
    extinction.operation = "MULTIPLY"
    extinction.inputs[1].default_value = 0.5 / VOXEL_M
    scatter, absorb, add = (
        nodes.new("ShaderNodeVolumeScatter"),
        nodes.new("ShaderNodeVolumeAbsorption"),
        nodes.new("ShaderNodeAddShader"),
    )
    out = nodes.new("ShaderNodeOutputMaterial")
    links.new(density.outputs["Fac"], extinction.inputs[0])
    for node in (scatter, absorb):
        links.new(extinction.outputs[0], node.inputs["Density"])
        links.new(colour.outputs["Color"], node.inputs["Color"])
        links.new(node.outputs[0], add.inputs[0 if node == scatter else 1])
    links.new(add.outputs[0], out.inputs["Volume"])
    data.materials.append(fog)


def light_and_camera():
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.data.angle = 9, 0.01
    sun.rotation_euler = (math.radians(45), 0, math.radians(-40))
    scene.collection.objects.link(sun)
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs[0].default_value = (0.42, 0.60, 0.95, 1)
    scene.world = world
    bpy.ops.mesh.primitive_plane_add(size=60, location=(side, -side / 2, 0))
    soil, nodes, links = material("soil")
    surface, out = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    surface.inputs[0].default_value = (0.085, 0.062, 0.040, 1)
    links.new(surface.outputs[0], out.inputs["Surface"])
    bpy.context.object.data.materials.append(soil)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = (side * 1.05, -side * 2.9, side * 0.75)
    camera.rotation_euler = (math.radians(73), 0, 0)
    camera.data.lens = 40
    scene.collection.objects.link(camera)
    scene.camera = camera


import_mesh()
import_volume()
light_and_camera()
scene.render.engine = "CYCLES"
scene.cycles.samples = samples
scene.cycles.volume_max_steps = 256
scene.cycles.max_bounces = 3
scene.render.resolution_x, scene.render.resolution_y = 640, 280
scene.view_settings.view_transform = "Standard"
scene.render.filepath = str(picture)
bpy.ops.render.render(write_still=True)
print(bpy.app.version_string, picture)
