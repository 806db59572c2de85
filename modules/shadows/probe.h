#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace gnomon {

/// A receiver of a frame, of which is asked how its visibility came about, see
/// ShadowTechnique::explain.
struct ProbedReceiver {
	glm::uvec2 pixel = glm::uvec2(0);			 // from the top left
	glm::dvec3 position_world = glm::dvec3(0.0); // where visibility is tested: off its surface
	/// How far it was moved off its surface, as a fraction of the most for a receiver of the scene:
	/// less near the camera. 0..1.
	double offset_share = 1;
	double visibility = 1; // of the mask, 0..1
};

/// A named value with further entries below it, as text for people and as JSON for programs.
/// Entries below one that is_list have no names.
struct ProbeEntry {
	using Value =
			std::variant<std::monostate, bool, int64_t, double, std::string, std::vector<double>>;

	std::string name;
	Value value;
	std::vector<ProbeEntry> entries;
	bool is_list = false;

	/// Adds an entry, and returns it. The reference is valid until the next call.
	ProbeEntry &add(std::string p_name, Value p_value = {}) {
		return entries.emplace_back(ProbeEntry{ std::move(p_name), std::move(p_value), {} });
	}
	void add(std::string p_name, const char *p_text) {
		add(std::move(p_name), Value(std::string(p_text)));
	}
	void add(std::string p_name, const glm::dvec3 &p_vector) {
		add(std::move(p_name), Value(std::vector<double>{ p_vector.x, p_vector.y, p_vector.z }));
	}
	void add(std::string p_name, glm::uvec2 p_vector) {
		ProbeEntry &vector = add(std::move(p_name));
		vector.add("x", int64_t(p_vector.x));
		vector.add("y", int64_t(p_vector.y));
	}
	ProbeEntry &add_list(std::string p_name) {
		ProbeEntry &list = add(std::move(p_name));
		list.is_list = true;
		return list;
	}
	/// Returns the entry with that name, or null.
	const ProbeEntry *find(std::string_view p_name) const {
		for (const ProbeEntry &entry : entries) {
			if (entry.name == p_name) {
				return &entry;
			}
		}
		return nullptr;
	}
};

} // namespace gnomon
