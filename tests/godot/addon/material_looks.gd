class_name MaterialLooks
## Makes materials by name. Where all masks are 1 the add-on must not change how they look; materials.gd checks that.

## Names of materials that the add-on patches, so that they read masks. "none": no material, which Godot draws with a default one.
const READS_MASKS: Array[String] = [
	"plain", "rough_0.1", "rough_0.3", "rough_1", "specular_0", "specular_1", "metal_0.35", "metal_0.5", "metal_0.8", "metal_1",
	"half_metal", "lambert", "wrap", "no_specular", "texture", "uv", "triplanar", "normal_map", "height", "detail", "emission",
	"ambient_occlusion", "vertex_color", "scissor", "hash", "both_sides", "orm", "none", "custom",
]
## Names of materials that the add-on cannot patch. It leaves them unchanged.
const STAYS: Array[String] = ["toon", "rim", "clearcoat", "anisotropy", "backlight", "subsurface", "per_vertex", "alpha", "own_light"]
## A shader with fragment(), to which the add-on appends. Its comment is a trap: it must not be taken for the function.
const STRIPES := "shader_type spatial;
uniform float count = 12.0;
varying float height;
float wave(float x) { return 0.5 + 0.5 * sin(count * x); }
void vertex() { height = VERTEX.y; }
void fragment() {
	// fragment() { in a comment
	ALBEDO = mix(vec3(0.9, 0.2, 0.1), vec3(0.2, 0.3, 0.8), wave(height));
	ROUGHNESS = 0.6;
	SPECULAR = 0.3;
}
"
const OWN_LIGHT := "shader_type spatial;
void fragment() { ALBEDO = vec3(0.7); }
void light() { DIFFUSE_LIGHT += LIGHT_COLOR * ATTENUATION * max(dot(NORMAL, LIGHT), 0.0) / PI; }
"


## Makes the material of that name; null for "none".
static func make(look: String) -> Material:
	if look == "none":
		return null
	if look in ["custom", "own_light"]:
		var custom := ShaderMaterial.new()
		custom.shader = Shader.new()
		custom.shader.code = STRIPES if look == "custom" else OWN_LIGHT
		return custom
	var material: BaseMaterial3D = ORMMaterial3D.new() if look == "orm" else StandardMaterial3D.new()
	material.albedo_color = Color(0.8, 0.5, 0.3)
	material.roughness = 0.7
	var parts := look.split("_")
	match parts[0]:  # the first word identifies the effect
		"rough":
			material.roughness = float(parts[1])
		"specular":
			material.metallic_specular = float(parts[1])
		"metal":
			material.metallic = 1.0
			material.roughness = float(parts[1])
		"half":
			material.metallic = 0.5
		"lambert":
			material.diffuse_mode = BaseMaterial3D.DIFFUSE_LAMBERT
		"wrap":
			material.diffuse_mode = BaseMaterial3D.DIFFUSE_LAMBERT_WRAP
		"no":
			material.specular_mode = BaseMaterial3D.SPECULAR_DISABLED
		"texture":
			material.albedo_texture = make_texture()
			material.roughness_texture = make_texture()
		"uv":
			material.albedo_texture = make_texture()
			material.uv1_scale = Vector3(3, 2, 1)
			material.uv1_offset = Vector3(0.25, 0.1, 0)
		"triplanar":
			material.albedo_texture = make_texture()
			material.uv1_triplanar = true
		"normal":
			material.normal_enabled = true
			material.normal_texture = make_texture()
			material.normal_scale = 0.5
		"height":
			material.heightmap_enabled = true
			material.heightmap_texture = make_texture()
			material.albedo_texture = make_texture()
		"detail":
			material.detail_enabled = true
			material.detail_albedo = make_texture()
			material.detail_mask = make_texture()
		"emission":
			material.emission_enabled = true
			material.emission = Color(0.1, 0.3, 0.1)
		"ambient":
			material.ao_enabled = true
			material.ao_texture = make_texture()
			material.ao_light_affect = 0.7
		"vertex":
			material.vertex_color_use_as_albedo = true
		"scissor":
			material.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA_SCISSOR
			material.albedo_texture = make_texture()
		"hash":
			material.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA_HASH
			material.albedo_texture = make_texture()
		"both":
			material.cull_mode = BaseMaterial3D.CULL_DISABLED
		"orm":
			material.orm_texture = make_texture()
		"toon":
			material.diffuse_mode = BaseMaterial3D.DIFFUSE_TOON
		"rim":
			material.rim_enabled = true
		"clearcoat":
			material.clearcoat_enabled = true
		"anisotropy":
			material.anisotropy_enabled = true
			material.anisotropy = 0.5
		"backlight":
			material.backlight_enabled = true
			material.backlight = Color(0.3, 0.1, 0.1)
		"subsurface":
			material.subsurf_scatter_enabled = true
			material.subsurf_scatter_strength = 0.5
		"per":
			material.shading_mode = BaseMaterial3D.SHADING_MODE_PER_VERTEX
		"alpha":
			material.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA
			material.albedo_color.a = 0.5
	return material


## Makes a texture that is smooth in all channels, with alphas from 0 to 1.
static func make_texture() -> Texture2D:
	var image := Image.create_empty(64, 64, false, Image.FORMAT_RGBA8)
	for y in 64:
		for x in 64:
			var u := TAU * x / 64.0
			var v := TAU * y / 64.0
			image.set_pixel(x, y, Color(0.6 + 0.3 * sin(u), 0.6 + 0.3 * cos(2 * v), 0.6 + 0.3 * sin(u + v), 0.5 + 0.5 * cos(3 * u)))
	return ImageTexture.create_from_image(image)
