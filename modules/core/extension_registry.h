#pragma once

#include "modules/core/error.h"

#include <algorithm>
#include <string_view>
#include <vector>

namespace gnomon {

/// A registry of extensions of one kind, such as commands or techniques. Modules add entries when
/// they start and remove them when they stop. Entries stay in the order of addition. Info must have
/// a string member `id` that is unique within the registry. Entries are added and removed on the
/// main thread only. Others may read while the main thread waits for them.
template <typename Info> class ExtensionRegistry {
public:
	/// Adds an entry. An id that is already registered is a programming error.
	static void add(Info p_info) {
		GNOMON_ASSERT(find(p_info.id) == nullptr, p_info.id, " is registered twice");
		infos.push_back(std::move(p_info));
	}
	/// Removes the entry with that id; does nothing if there is none.
	static void remove(std::string_view p_id) {
		std::erase_if(infos, [&](const Info &p_info) { return p_info.id == p_id; });
	}
	/// Returns the entry with that id, or null. The pointer is valid until the next add or remove.
	static const Info *find(std::string_view p_id) {
		return find_if([&](const Info &p_info) { return p_info.id == p_id; });
	}
	static const std::vector<Info> &get_all() { return infos; }

protected:
	/// Returns the first entry for which the predicate is true, or null.
	template <typename Predicate> static const Info *find_if(Predicate p_is_match) {
		const auto found = std::find_if(infos.begin(), infos.end(), p_is_match);
		return found == infos.end() ? nullptr : &*found;
	}

private:
	inline static std::vector<Info> infos;
};

} // namespace gnomon
