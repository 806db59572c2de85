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

/// What a module declares for a technique when it registers it.
struct ShadowTechniqueInfo {
	std::string id; // stored in scene files; never changes
	std::string name;
	std::string source; // paper, book, section
	std::string color;	// "#rrggbb", its own: it is drawn so in every plot
	std::function<std::unique_ptr<ShadowTechnique>()> make;
	/// The highest rank is what a light without shadow_technique gets; 0 = never by default.
	int default_rank = 0;
	/// Takes over for lights whose technique is missing.
	bool is_fallback = false;
	/// Exact within its sampling error: what the others are measured against.
	bool is_reference = false;
	/// Of a reference: the same mask without a device, for whoever cannot wait for a frame. Empty:
	/// there is no such way.
	std::function<std::unique_ptr<ReferenceSource>(ReferenceQuestion)> make_reference_source = {};
	/// There to be copied, not to be measured: the error report skips it unless it is named.
	bool is_example = false;
	/// Shadows fall on instances alone that their node declares planar; of no use to a host whose
	/// nodes cannot (InstanceSnapshot::is_planar_receiver).
	bool needs_planar_receivers = false;
};

/// All techniques there are.
class ShadowRegistry : public Registry<ShadowTechniqueInfo> {
public:
	/// As find; absent: an Error that lists the ids there are.
	static const ShadowTechniqueInfo &get(std::string_view p_id);
	/// Null where no candidate is registered.
	static const ShadowTechniqueInfo *find_default();
	static const ShadowTechniqueInfo *find_fallback();
	static const ShadowTechniqueInfo *find_reference();

	static void add(ShadowTechniqueInfo p_info);
	static void remove(std::string_view p_id);
	/// The settings of a technique that must exist: how it computes, for all lights alike; no value
	/// changes what its masks should be. project.cfg has them as [technique.ID], the command line
	/// as --set technique.ID.NAME=value.
	static const PropertyList &get_settings(std::string_view p_id);
	/// All of them, as set or by default.
	static const PropertyValues &get_setting_values(std::string_view p_id);
	/// From the next frame on. p_text as parse_property reads it; an id, name or value that does
	/// not exist is an Error that lists those that do.
	static void set_setting(
			std::string_view p_id, std::string_view p_name, std::string_view p_text);
};

/// Settings for tests, benchmarks and comparisons: their group. No page and no list shows them.
extern const char *const TEST_SETTINGS_GROUP;

/// Applies the [technique.ID] sections of a project. What another build knows and this one does not
/// only warns: the project must open everywhere.
void apply_technique_settings(const Project &p_project);

/// Which technique a light gets, and why another than it requests.
struct TechniqueChoice {
	const ShadowTechniqueInfo *info = nullptr; // null: no shadow, v = 1
	std::string warning;					   // empty when the light gets what it requests
};
/// p_override: an id that replaces every light's own; must exist when not empty.
TechniqueChoice choose_technique(const LightSnapshot &p_light, const std::string &p_override);

} // namespace gnomon
