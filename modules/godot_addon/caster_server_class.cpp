// Registers the class GnomonServer and its singleton, which server_casters.h declares.

#include "modules/godot_addon/extension_class.h"
#include "modules/godot_addon/server_casters.h"

namespace gnomon {

namespace {

using godot::BuiltInType;
using godot::get_interface;
using godot::StringName;
using godot::Variant;

const char SERVER_BASE_NAME[] = "Object";

std::unique_ptr<ServerCasters> server_casters;
void *singleton = nullptr;

Variant add_caster(void *, std::span<const Variant> p_arguments) {
	get_server_casters().add(p_arguments[0].to_rid(), p_arguments[1].to_rid(),
			p_arguments[2].to_transform(), p_arguments[3].to_int(), p_arguments[4].to_rid());
	return {};
}

Variant move_caster(void *, std::span<const Variant> p_arguments) {
	get_server_casters().move(p_arguments[0].to_rid(), p_arguments[1].to_transform());
	return {};
}

Variant remove_caster(void *, std::span<const Variant> p_arguments) {
	get_server_casters().remove(p_arguments[0].to_rid());
	return {};
}

Variant count_casters(void *, std::span<const Variant>) {
	return int64_t(get_server_casters().get().size());
}

const std::vector<MethodEntry> &get_server_methods() {
	static const std::vector<MethodEntry> methods = {
		{ "add_caster", &add_caster,
				{ { "instance", BuiltInType::RID }, { "mesh", BuiltInType::RID },
						{ "transform", BuiltInType::TRANSFORM3D }, { "layers", BuiltInType::INT },
						{ "material", BuiltInType::RID } },
				{} },
		{ "move_caster", &move_caster,
				{ { "instance", BuiltInType::RID }, { "transform", BuiltInType::TRANSFORM3D } },
				{} },
		{ "remove_caster", &remove_caster, { { "instance", BuiltInType::RID } }, {} },
		{ "count_casters", &count_casters, {}, BuiltInType::INT },
	};
	return methods;
}

void *create_server_instance(void *, GDExtensionBool) {
	void *object = nullptr;
	log_failures([&] {
		const StringName base(SERVER_BASE_NAME);
		const StringName name(CASTER_SERVER_NAME);
		object = get_interface().classdb_construct_object2(base.get());
		get_interface().object_set_instance(object, name.get(), object);
	});
	return object;
}

void free_server_instance(void *, void *) {}

} // namespace

ServerCasters &get_server_casters() {
	if (!server_casters) {
		server_casters = std::make_unique<ServerCasters>();
	}
	return *server_casters;
}

std::string write_server_documentation() {
	const auto write_method = [](const char *p_name, const char *p_parameters, const char *p_text) {
		return text("\t\t<method name=\"", p_name, "\">\n\t\t\t<return type=\"void\" />\n",
				p_parameters, "\t\t\t<description>\n\t\t\t\t", p_text,
				"\n\t\t\t</description>\n\t\t</method>\n");
	};
	const char *instance = "\t\t\t<param index=\"0\" name=\"instance\" type=\"RID\" />\n";
	return text("<class name=\"GnomonServer\" inherits=\"Object\" version=\"4.5\">\n"
				"\t<brief_description>\n\t\tCasters that are no nodes.\n"
				"\t</brief_description>\n\t<description>\n"
				"\t\tA singleton, with which terrain and voxel add-ons make instances of the "
				"[RenderingServer] cast Gnomon's shadows in the world of the main window.\n"
				"\t</description>\n\t<methods>\n",
			write_method("add_caster",
					"\t\t\t<param index=\"0\" name=\"instance\" type=\"RID\" />\n"
					"\t\t\t<param index=\"1\" name=\"mesh\" type=\"RID\" />\n"
					"\t\t\t<param index=\"2\" name=\"transform\" type=\"Transform3D\" />\n"
					"\t\t\t<param index=\"3\" name=\"layers\" type=\"int\" />\n"
					"\t\t\t<param index=\"4\" name=\"material\" type=\"RID\" />\n",
					"Adds a caster, or replaces that of [param instance]. [param layers]: as in "
					"[member Light3D.shadow_caster_mask], at least one bit. [param material]: that "
					"of all surfaces, or an empty RID for the mesh's own. The triangles are "
					"copied."),
			write_method("move_caster",
					text(instance,
							"\t\t\t<param index=\"1\" name=\"transform\" "
							"type=\"Transform3D\" />\n")
							.c_str(),
					"Moves a caster."),
			write_method("remove_caster", instance,
					"Removes a caster, also after its instance was freed."),
			"\t\t<method name=\"count_casters\">\n\t\t\t<return type=\"int\" />\n"
			"\t\t\t<description>\n\t\t\t\tReturns the number of casters."
			"\n\t\t\t</description>\n\t\t</method>\n"
			"\t</methods>\n</class>\n");
}

void register_caster_server() {
	const StringName name(CASTER_SERVER_NAME);
	const StringName base(SERVER_BASE_NAME);
	GDExtensionClassCreationInfo5 info = {};
	info.is_exposed = true;
	info.create_instance_func = &create_server_instance;
	info.free_instance_func = &free_server_instance;
	const godot::Interface &interface = get_interface();
	interface.classdb_register_extension_class5(interface.extension, name.get(), base.get(), &info);
	for (const MethodEntry &entry : get_server_methods()) {
		register_method(name, entry);
	}
	singleton = create_server_instance(nullptr, false);
	godot::Engine(godot::find_singleton("Engine"))
			.register_singleton(CASTER_SERVER_NAME, godot::Object(singleton));
}

void unregister_caster_server() {
	server_casters.reset();
	if (singleton) {
		godot::Engine(godot::find_singleton("Engine")).unregister_singleton(CASTER_SERVER_NAME);
		get_interface().object_destroy(singleton);
		singleton = nullptr;
	}
	const StringName name(CASTER_SERVER_NAME);
	get_interface().classdb_unregister_extension_class(get_interface().extension, name.get());
}

} // namespace gnomon
