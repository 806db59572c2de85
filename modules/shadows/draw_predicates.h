#pragma once

#include "modules/render_graph/render_graph.h"

#include <memory>
#include <optional>
#include <vector>

namespace gnomon {

/// Predicates for conditional rendering (VK_EXT_conditional_rendering): one 32-bit word per caster,
/// written on the GPU in the same frame. The draws and dispatches of a caster execute only when its
/// word is not 0. Casters without a word always execute. By default no caster has a word.
struct DrawPredicates {
	RGBuffer words;					 // with BufferUsage::CONDITIONAL
	uint64_t first_offset_bytes = 0; // of the first instance's word; a header may precede it
	/// The instances that have a word, ascending, in the words' order.
	std::shared_ptr<const std::vector<uint32_t>> instances;

	/// Byte offset of the instance's word in `words`; none for an instance without a word.
	std::optional<uint64_t> find_offset_bytes(uint32_t p_instance_index) const;
	/// Declares the use of the words in a pass.
	void add_to(PassBuilder &r_pass) const;
	/// Records the commands of p_record so that they execute only when the instance's word is set.
	template <typename Record>
	void record(PassContext &r_context, uint32_t p_instance_index, Record p_record) const {
		const std::optional<uint64_t> offset = find_offset_bytes(p_instance_index);
		if (offset) {
			r_context.commands.begin_conditional(r_context.get(words), *offset);
		}
		p_record();
		if (offset) {
			r_context.commands.end_conditional();
		}
	}
};

} // namespace gnomon
