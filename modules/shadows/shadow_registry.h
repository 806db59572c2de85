#pragma once

#include "modules/core/project.h"
#include "modules/shadows/reference_source.h"
#include "modules/shadows/registry.h"
#include "modules/shadows/shadow_technique.h"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

/// Description of a technique, which its module registers.
struct ShadowTechniqueInfo {
	std::string id; // stored in scene files; never changes
	std::string name;
	std::string source; // paper, book, section
	std::string color;	// "#rrggbb", unique: the technique's colour in all plots
	std::function<std::unique_ptr<ShadowTechnique>()> make;
	/// A light without shadow_technique gets the technique of the highest rank; 0 = never.
	int default_rank = 0;
	/// True: replaces the technique of lights whose own is not registered.
	bool is_fallback = false;
	/// True: exact within its sampling error; the other techniques are measured against it.
	bool is_reference = false;
	/// For a reference: computes the same mask on the CPU, for callers that cannot wait for a
	/// frame. Empty: not available.
	std::function<std::unique_ptr<ReferenceSource>(ReferenceRequest)> make_reference_source = {};
	/// True: a template to copy. The error report skips it unless the user names it.
	bool is_example = false;
	/// True: only instances whose node declares them planar receive shadows
	/// (InstanceSnapshot::is_planar_receiver). Useless in a host whose nodes cannot declare it.
	bool needs_planar_receivers = false;
	/// The widths r and t of lights that set none, for a technique whose error is smaller with
	/// other widths than the light's size R.
	DerivedWidths derived_widths = {};
};

/// All registered techniques.
class ShadowRegistry : public Registry<ShadowTechniqueInfo> {
public:
	/// As find, but throws an Error that lists the registered ids when p_id is not one.
	static const ShadowTechniqueInfo &get(std::string_view p_id);
	/// The next three return null when no such technique is registered.
	static const ShadowTechniqueInfo *find_default();
	static const ShadowTechniqueInfo *find_fallback();
	static const ShadowTechniqueInfo *find_reference();

	static void add(ShadowTechniqueInfo p_info);
	static void remove(std::string_view p_id);
	/// The settings of a technique, which must be registered: how it computes, for all lights. They
	/// change time or memory, not the mask, except those for tests (TEST_SETTINGS_GROUP). Set in
	/// project.cfg under [technique.ID], or on the command line with --set technique.ID.NAME=value.
	static const PropertyList &get_settings(std::string_view p_id);
	/// The values of all settings of a technique, as set or by default.
	static const PropertyValues &get_setting_values(std::string_view p_id);
	/// Sets a value from the next frame on. p_text: see parse_property. Throws an Error that lists
	/// the valid choices for an id, name or value that does not exist.
	static void set_setting(
			std::string_view p_id, std::string_view p_name, std::string_view p_text);
};

/// The property group of settings for tests, benchmarks and comparisons. No page or list shows it.
extern const char *const TEST_SETTINGS_GROUP;

/// Resets all settings to their defaults, then applies the [technique.ID] sections of a project.
/// Unknown ids, names and values only cause a warning, so that the project opens in every build.
void apply_technique_settings(const Project &p_project);

/// The technique that a light gets, and why it is not the requested one.
struct TechniqueChoice {
	const ShadowTechniqueInfo *info = nullptr; // null: no shadow, visibility is 1
	std::string warning;					   // empty when the light gets what it requests
};
/// p_override: an id that replaces every light's own; must exist when not empty.
TechniqueChoice choose_technique(const LightSnapshot &p_light, const std::string &p_override);

} // namespace gnomon
