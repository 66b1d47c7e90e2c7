# SPDX-License-Identifier: Apache-2.0
# Godot 3.2: the layers of a Sward export as quads, read at run time from stack.json and the PNG atlas of variant 0:
#   godot3 --path docs/elsewhere/godot EXPORT_DIR PICTURE.png
extends Spatial

const SHADER = """
shader_type spatial;
render_mode cull_disabled, unshaded, depth_draw_never;
uniform sampler2D atlas : hint_albedo;
uniform vec4 place;
uniform float height;
void fragment() {
	vec4 texel = texture(atlas, mix(place.xy, place.zw, UV));
	// Light that the canopy lets through to this height, and the day's: enough for a picture.
	ALBEDO = texel.rgb * (4.5 * exp(-0.96 * (1.0 - height)) + 0.7 * exp(-1.1 * (1.0 - height)));
	ALPHA = texel.a;
}
"""

# Godot works in its project's folder: what the user named lies where the user stood.
func place_of(path):
	return path if path.is_abs_path() else OS.get_environment("PWD") + "/" + path

func read_json(path):
	var file = File.new()
	if file.open(path, File.READ) != OK:
		print("error: ", path, ": cannot read: expected what texgen export --for textures writes")
		return null
	return JSON.parse(file.get_as_text()).result

func _ready():
	var arguments = OS.get_cmdline_args()
	var folder = place_of(arguments[-2])
	var stack = read_json(folder + "/stack.json")
	if stack == null:
		get_tree().quit(1)
		return
	var image = Image.new()
	image.load(folder + "/" + stack["arrays"]["layers"]["atlases"][0]["albedo"][1])
	var atlas = ImageTexture.new()
	atlas.create_from_image(image, Texture.FLAG_MIPMAPS | Texture.FLAG_FILTER)
	var shader = Shader.new()
	shader.code = SHADER
	var side = stack["side_m"]
	for entry in stack["images"]:
		if entry["array"] != "layers" or entry["variant"] != 0:
			continue
		var material = ShaderMaterial.new()
		material.shader = shader
		material.render_priority = int(entry["index"]) # from the ground up
		var uv = entry["atlas_uv"]
		material.set_shader_param("atlas", atlas)
		material.set_shader_param("place", Plane(uv[0], uv[1], uv[2], uv[3]))
		material.set_shader_param("height", entry["height_m"] / stack["canopy_m"])
		for z in range(-6, 2):
			for x in range(-5, 5):
				var quad = MeshInstance.new()
				quad.mesh = PlaneMesh.new()
				quad.mesh.size = Vector2(side, side)
				quad.material_override = material
				quad.translation = Vector3((x + 0.5) * side, entry["height_m"], (z + 0.5) * side)
				add_child(quad)
	var soil = MeshInstance.new()
	soil.mesh = PlaneMesh.new()
	soil.mesh.size = Vector2(400, 400)
	soil.material_override = SpatialMaterial.new()
	soil.material_override.flags_unshaded = true
	soil.material_override.albedo_color = Color(0.31, 0.27, 0.22)
	add_child(soil)
	var camera = Camera.new()
	add_child(camera)
	camera.look_at_from_position(Vector3(0, 2.4, 1.6), Vector3(0, 0, -0.6), Vector3.UP)
	camera.current = true
	for i in range(5):
		yield(get_tree(), "idle_frame")
	yield(VisualServer, "frame_post_draw")
	var picture = get_viewport().get_texture().get_data()
	picture.flip_y()
	print(Engine.get_version_info()["string"], " ", stack["images"].size(), " images, saved: ", picture.save_png(place_of(arguments[-1])))
	get_tree().quit()
