#pragma once

#include "modules/core/error.h"
#include "modules/shadows/light_properties.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

/// Everything of one kind that modules have registered, in that order. Main thread only.
///
/// Info has an `id`, which is stored in files and never changes, and `make`, whose product declares
/// its light properties.
template <typename Info> class Registry {
public:
	/// An id that is present already is our mistake.
	static void add(Info p_info) {
		GNOMON_ASSERT(!find(p_info.id), p_info.id, " is registered twice");
		PropertyList list;
		p_info.make()->get_light_properties(list);
		check_own_properties(p_info.id, list);
		properties[p_info.id] = std::move(list);
		infos.push_back(std::move(p_info));
		++revision;
	}
	/// Who holds what was made of it drops it before the next frame (see get_revision).
	static void remove(std::string_view p_id) {
		std::erase_if(infos, [&](const Info &p_info) { return p_info.id == p_id; });
		if (const auto found = properties.find(p_id); found != properties.end()) {
			properties.erase(found);
		}
		++revision;
	}
	/// Null: nothing has that id.
	static const Info *find(std::string_view p_id) {
		return find_if([&](const Info &p_info) { return p_info.id == p_id; });
	}
	static const std::vector<Info> &get_all() { return infos; }
	/// Light properties of one that must exist.
	static const PropertyList &get_light_properties(std::string_view p_id) {
		const auto found = properties.find(p_id);
		GNOMON_ASSERT(found != properties.end(), p_id, " is not registered");
		return found->second;
	}
	/// Counts adds and removes.
	static uint64_t get_revision() { return revision; }

protected:
	/// The first of which that is true, or null.
	template <typename Predicate> static const Info *find_if(Predicate p_is_wanted) {
		const auto found = std::find_if(infos.begin(), infos.end(), p_is_wanted);
		return found == infos.end() ? nullptr : &*found;
	}

private:
	inline static std::vector<Info> infos;
	inline static std::map<std::string, PropertyList, std::less<>> properties;
	inline static uint64_t revision = 0;
};

} // namespace gnomon
