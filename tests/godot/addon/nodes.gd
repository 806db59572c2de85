extends AddonTest
## The properties and warnings of the node GnomonShadow3D, and how it reacts to bad values and new parents.


func test_the_node_works_only_below_a_light() -> void:
	var scene := add_study()
	check(scene.shadow.get_warning().is_empty(), "no warning below a light with a size")
	scene.light.light_size = 0.0
	check("light_size" in scene.shadow.get_warning(), "a light without a size is warned of")
	scene.light.light_size = 0.5
	var second: Node3D = ClassDB.instantiate("GnomonShadow3D")
	scene.light.add_child(second)
	check("another" in second.get_warning(), "a second node is warned of")
	check(count_darker(await read_settled(scene)) > 500, "the first one counts")
	scene.light.remove_child(second)
	scene.add_child(second)
	check("not a light" in second.get_warning(), "a node elsewhere is warned of")
	scene.light.remove_child(scene.shadow)
	await draw_frames(2)
	scene.light.add_child(scene.shadow)
	check(count_darker(await read_settled(scene)) > 500, "a node that comes back works again")


func test_properties_follow_the_technique() -> void:
	var shadow: Node3D = ClassDB.instantiate("GnomonShadow3D")
	check(shadow.technique == "default", "the project's technique is the default")
	var shown := _list_shown(shadow)
	check("penumbra_outer_width" in shown and "penumbra_inner_width" in shown, "widths are shown")
	check(not shown.any(func(property: String) -> bool: return property.begins_with("pcss_")), "no property of PCSS is shown")
	shadow.technique = "pcss"
	shown = _list_shown(shadow)
	var of_pcss := shown.filter(func(property: String) -> bool: return property.begins_with("pcss_"))
	check(not of_pcss.is_empty(), "the properties of PCSS are shown once it is chosen")
	for property: String in of_pcss:
		check(shadow.get(property) == ClassDB.class_get_property_default_value("GnomonShadow3D", property), property + " has its default")
	shadow.free()


func _list_shown(shadow: Node3D) -> Array[String]:
	var shown: Array[String] = []
	for property in shadow.get_property_list():
		if property.usage & PROPERTY_USAGE_EDITOR:
			shown.append(property.name)
	return shown


func test_values_out_of_range_are_refused() -> void:
	var shadow: Node3D = ClassDB.instantiate("GnomonShadow3D")
	shadow.technique = "no such technique"
	check(shadow.technique == "default", "the technique stays")
	shadow.penumbra_outer_width = -5.0
	check(shadow.penumbra_outer_width == -1.0, "the width stays")
	shadow.penumbra_outer_width = NAN
	check(shadow.penumbra_outer_width == -1.0, "and is no NaN")
	shadow.free()


func test_packed_scenes_store_all_properties_that_were_set() -> void:
	var shadow: Node3D = ClassDB.instantiate("GnomonShadow3D")
	shadow.technique = "pcss"
	shadow.penumbra_outer_width = 0.25
	shadow.pcss_map_size = 512
	shadow.technique = "penumbra_fins"
	var packed := PackedScene.new()
	packed.pack(shadow)
	var again := packed.instantiate()
	check(again.technique == "penumbra_fins", "the technique")
	check(again.penumbra_outer_width == 0.25, "the width")
	check(again.pcss_map_size == 512, "what was set for another technique")
	shadow.free()
	again.free()


## The device times the passes of a light with a time budget.
func test_a_time_budget_limits_what_is_counted() -> void:
	var scene := add_study("spot", "torus")
	var torus: TorusMesh = scene.caster.mesh
	torus.rings = 256
	torus.ring_segments = 128
	scene.light.light_size = 0.8
	var counted := await read_settled(scene)
	scene.shadow.set("edge_count_time_budget", 0.1)
	await draw_frames(8)
	var filtered := await read(scene)
	check(count_different(counted, filtered, 0.01) > 100, "leaves with many edges are filtered")
	check(count_different(counted, filtered, 0.3) < 400, "the filtered mask is near the counted one")
	scene.shadow.set("edge_count_time_budget", 1000.0)
	await draw_frames(8)
	check(count_different(counted, await read(scene)) == 0, "with time for everything, everything is counted")
	remove(scene)
