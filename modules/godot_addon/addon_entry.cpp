// The library's entry point: Godot calls it when it loads the add-on.

#include "modules/core/log_failures.h"
#include "modules/core/module_registry.h"
#include "modules/godot_addon/addon_server.h"
#include "modules/godot_addon/receiver_textures.h"
#include "modules/godot_addon/server_casters.h"
#include "modules/godot_addon/shadow_node.h"
#include "modules/godot_addon/shadow_properties.h"
#include "modules/rendering_device_godot/godot_interface.h"

#include <cstdio>

namespace gnomon {

namespace {

std::unique_ptr<AddonServer> addon_server;
std::unique_ptr<ReceiverGlobals> receiver_globals;

void log_to_godot(LogLevel p_level, const std::string &p_line) {
	const std::string line = "Gnomon: " + p_line;
	const godot::Interface &interface = godot::get_interface();
	if (p_level == LogLevel::ERROR) {
		interface.print_error(line.c_str(), /*p_function=*/"", /*p_file=*/"gnomon", /*p_line=*/0,
				/*p_editor_notify=*/false);
	} else if (p_level == LogLevel::WARNING) {
		interface.print_warning(line.c_str(), /*p_function=*/"", /*p_file=*/"gnomon", /*p_line=*/0,
				/*p_editor_notify=*/false);
	}
}

void start_server() {
	log_failures([] {
		receiver_globals = std::make_unique<ReceiverGlobals>();
		addon_server = std::make_unique<AddonServer>();
	});
}

void stop_server() {
	log_failures([] {
		addon_server.reset();
		receiver_globals.reset();
	});
}

void initialize_level(GDExtensionInitializationLevel p_level) {
	const godot::Interface &interface = godot::get_interface();
	if (p_level == GDEXTENSION_INITIALIZATION_EDITOR) {
		for (const std::string &documentation :
				{ write_class_documentation(), write_server_documentation() }) {
			interface.editor_help_load_xml_from_utf8_chars_and_len(
					documentation.data(), static_cast<GDExtensionInt>(documentation.size()));
		}
	}
	if (p_level != GDEXTENSION_INITIALIZATION_SCENE) {
		return;
	}
	set_log_sink(log_to_godot);
	set_log_level(LogLevel::WARNING);
	register_modules();
	ModuleRegistry::initialize(ModuleLevel::FEATURES);
	register_shadow_node_class();
	register_caster_server();
	GDExtensionMainLoopCallbacks callbacks = {};
	callbacks.startup_func = &start_server; // the RenderingServer exists by then
	callbacks.shutdown_func = &stop_server;
	interface.register_main_loop_callbacks(interface.extension, &callbacks);
}

void initialize(void *, GDExtensionInitializationLevel p_level) {
	log_failures([&] { initialize_level(p_level); });
}

void uninitialize(void *, GDExtensionInitializationLevel p_level) {
	if (p_level == GDEXTENSION_INITIALIZATION_SCENE) {
		stop_server();
		log_failures([] {
			unregister_caster_server();
			unregister_shadow_node_class();
			ModuleRegistry::uninitialize();
		});
		set_log_sink({});
	}
}

} // namespace

} // namespace gnomon

#ifdef _WIN32
#define ENTRY_POINT extern "C" // exports.def exports it
#else
#define ENTRY_POINT extern "C" __attribute__((visibility("default")))
#endif

ENTRY_POINT GDExtensionBool gnomon_addon_init(GDExtensionInterfaceGetProcAddress p_get_address,
		GDExtensionClassLibraryPtr p_library, GDExtensionInitialization *r_initialization) {
	try {
		gnomon::godot::load_interface(p_get_address, p_library);
	} catch (const std::exception &failure) {
		std::fprintf(stderr, "Gnomon: %s\n", failure.what());
		return 0;
	}
	r_initialization->minimum_initialization_level = GDEXTENSION_INITIALIZATION_SCENE;
	r_initialization->initialize = gnomon::initialize;
	r_initialization->deinitialize = gnomon::uninitialize;
	return 1;
}
