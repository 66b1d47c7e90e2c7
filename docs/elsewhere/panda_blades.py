# SPDX-License-Identifier: Apache-2.0
"""blades_mesh.glb in Panda3D, bent by the wind from its second UV: panda_blades.py OUT_FOLDER
PICTURE.png
    pip install panda3d panda3d-gltf
    texgen export SET -o out/gltf --for gltf
Draws without a window or a GPU; prints what the loader made of the file. Ends with 1 where the mesh
or its picture is not as exported."""

import json
import struct
import sys
import tempfile
from pathlib import Path

from panda3d.core import (
    CardMaker,
    Filename,
    GraphicsPipe,
    FrameBufferProperties,
    NodePath,
    PNMImage,
    Shader,
    Vec3,
    Vec4,
    WindowProperties,
    loadPrcFileData,
)

loadPrcFileData(
    "",
    "load-display p3headlessgl\naudio-library-name null\ngl-version 3 3\nnotify-level-display error",
)
from direct.showbase.ShowBase import ShowBase  # noqa: E402  reads what was set above
import gltf  # noqa: E402

SIZE = (804, 400)
VERTEX = """#version 330
uniform mat4 p3d_ModelViewProjectionMatrix;
uniform vec3 wind; // its direction, level, times how far a tip goes
in vec4 p3d_Vertex;
in vec3 p3d_Normal;
in vec4 p3d_Color;
in vec2 p3d_MultiTexCoord1; // _WIND.x, .y as a UV; the loader turns v over
out vec3 normal, albedo;
void main() {
    float flutter = 1.0 + 0.3 * sin(6.2832 * p3d_MultiTexCoord1.y);
    vec3 place = p3d_Vertex.xyz + wind * (p3d_MultiTexCoord1.x * flutter);
    normal = p3d_Normal;
    albedo = p3d_Color.rgb;
    gl_Position = p3d_ModelViewProjectionMatrix * vec4(place, 1.0);
}"""
FRAGMENT = """#version 330
uniform vec3 to_sun;
in vec3 normal, albedo;
out vec4 colour;
void main() {
    float sun = abs(dot(normalize(normal), to_sun)); // a blade is lit on both sides
    vec3 light = vec3(3.8, 3.5, 2.9) * sun + vec3(0.45, 0.55, 0.75);
    colour = vec4(pow(clamp(albedo * light, 0.0, 1.0), vec3(1.0 / 2.2)), 1.0);
}"""


def scene(base, blades, wind):
    blades.reparent_to(base.render)
    shader = Shader.make(Shader.SL_GLSL, VERTEX, FRAGMENT)
    blades.set_shader(shader)
    blades.set_shader_input("to_sun", Vec3(0.58, -0.58, 0.57))
    blades.set_shader_input("wind", wind)
    blades.set_two_sided(True)
    soil = CardMaker("soil")
    soil.set_frame(-12, 12, -12, 12)
    soil.set_color(0.36, 0.33, 0.26, 1)
    base.render.attach_new_node(soil.generate()).set_p(-90)


def picture(blades, name, wind):
    base = ShowBase(windowType="offscreen")
    scene(base, blades, wind)
    low, high = blades.get_tight_bounds()
    middle = (low + high) / 2
    frame = FrameBufferProperties()
    frame.set_rgb_color(True)
    frame.set_depth_bits(24)
    frame.set_multisamples(4)
    buffer = base.graphicsEngine.make_output(
        base.pipe,
        "picture",
        0,
        frame,
        WindowProperties.size(*SIZE),
        GraphicsPipe.BF_refuse_window,
        base.win.get_gsg(),
        base.win,
    )
    buffer.set_clear_color(Vec4(0.76, 0.86, 0.95, 1))
    camera = base.makeCamera(buffer, camName="eye")
    camera.node().get_lens().set_aspect_ratio(SIZE[0] / SIZE[1])
    camera.node().get_lens().set_fov(60)
    camera.set_pos(middle.x, low.y - 1.0, 0.9)
    camera.look_at(middle.x, low.y + 1.0, 0.2)
    for _ in range(2):
        base.graphicsEngine.render_frame()
    image = PNMImage()
    if not buffer.get_screenshot(image):
        raise SystemExit("no picture could be read back")
    image.write(Filename.from_os_specific(str(Path(name).resolve())))
    return sum(
        image.get_green(x, y) > 1.1 * image.get_blue(x, y)
        for x in range(0, SIZE[0], 4)
        for y in range(0, SIZE[1], 4)
    ) / (SIZE[0] * SIZE[1] / 16)


def loaded(path):
    """The loader (1.3.0) takes every attribute of an application for one of the same name and
    fails: they are left out before."""
    data = path.read_bytes()
    (size,) = struct.unpack_from("<I", data, 12)
    described = json.loads(data[20 : 20 + size])
    for mesh in described["meshes"]:
        for primitive in mesh["primitives"]:
            primitive["attributes"] = {
                key: value
                for key, value in primitive["attributes"].items()
                if not key.startswith("_")
            }
    text = json.dumps(described).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + size :]
    with tempfile.TemporaryDirectory() as folder:
        plain = Path(folder) / "blades.glb"
        plain.write_bytes(
            data[:8]
            + struct.pack("<I", 20 + len(text) + len(rest))
            + struct.pack("<I4s", len(text), b"JSON")
            + text
            + rest
        )
        return NodePath(gltf.load_model(str(plain)))


def main(out, name):
    blades = loaded(Path(out).resolve() / "gltf/blades_mesh.glb")
    columns, triangles = set(), 0
    for node in blades.find_all_matches("**/+GeomNode"):
        for i in range(node.node().get_num_geoms()):
            geom = node.node().get_geom(i)
            columns |= {
                str(c.get_name()) for c in geom.get_vertex_data().get_format().get_columns()
            }
            triangles += sum(p.get_num_faces() for p in geom.get_primitives())
    low, high = blades.get_tight_bounds()
    print("triangles", triangles, "columns", sorted(columns), "from", low, "to", high)
    share = picture(blades, name, Vec3(0.12, 0.0, -0.01))
    print(f"green in {100 * share:.1f} % of the picture")
    return not (
        {"vertex", "normal", "color", "texcoord.1"} <= columns and triangles > 0 and share > 0.2
    )


sys.exit(main(*sys.argv[1:]))
