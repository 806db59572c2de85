#pragma once

#include "modules/core/extension_registry.h"
#include "modules/shadows/light_properties.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace gnomon {

/// Registry of extensions that add properties to lights. Info::make creates the object that
/// declares them. Owners of such objects drop them before the next frame when get_revision()
/// changes.
template <typename Info> class Registry : public ExtensionRegistry<Info> {
public:
	static void add(Info p_info) {
		PropertyList list;
		p_info.make()->get_light_properties(list);
		check_extension_properties(p_info.id, list);
		properties[p_info.id] = std::move(list);
		ExtensionRegistry<Info>::add(std::move(p_info));
		++revision;
	}
	static void remove(std::string_view p_id) {
		ExtensionRegistry<Info>::remove(p_id);
		properties.erase(std::string(p_id));
		++revision;
	}
	/// Light properties of the extension p_id, which must be registered.
	static const PropertyList &get_light_properties(std::string_view p_id) {
		const auto found = properties.find(p_id);
		GNOMON_ASSERT(found != properties.end(), p_id, " is not registered");
		return found->second;
	}
	/// Returns a number that grows with each add and remove.
	static uint64_t get_revision() { return revision; }

private:
	inline static std::map<std::string, PropertyList, std::less<>> properties;
	inline static uint64_t revision = 0;
};

} // namespace gnomon
