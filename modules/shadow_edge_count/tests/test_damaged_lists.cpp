// Lists that a faulty pass could leave: with counts or indices beyond all buffers. A frame
// must end, its mask must be in 0..1, and one warning must name the light and the pass.

#include "modules/core/log.h"
#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include <doctest/doctest.h>

#include <set>

using namespace gnomon;

namespace {

enum class Damage { NONE, COUNTS_BEYOND, ENTRIES_BEYOND };
Damage damage = Damage::NONE; // of the next frames

/// edge_count with lists that are damaged before they are read.
class DamagedEdgeCount : public ShadowEdgeCount {
protected:
	void after_lists(RenderGraph &r_graph, const CountFrameBuffers & /*p_light*/,
			const CountLeaves &p_leaves) override {
		const RGBuffer targets[] = { {}, p_leaves.results, p_leaves.lists };
		const RGBuffer target = targets[static_cast<int>(damage)];
		if (!target) {
			return;
		}
		const auto word_count =
				static_cast<uint32_t>(r_graph.get_desc(target).size_bytes / sizeof(uint32_t));
		const uint32_t push[] = { 0x7ffffff0u, word_count };
		add_compute_pass(r_graph, "damage lists",
				device->get_compute_pipeline({ "damage lists", "tests/damage_words.comp" }),
				{ PassBinding::write(0, target, PassBuilder::Content::UPDATE) },
				{ word_count, 1, 1 }, { reinterpret_cast<const uint8_t *>(push), sizeof(push) });
	}

public:
	static inline RenderingDevice *device = nullptr;
};

/// The lines that log_fault logs.
struct CaughtFaults {
	std::vector<std::string> lines;
	LogFilterScope filter{ [this](LogLevel, const std::string &p_line) {
		if (!p_line.starts_with(FAULT_PREFIX)) {
			return true;
		}
		lines.push_back(p_line);
		return false;
	} };
	size_t count(const std::string &p_part) const {
		return size_t(std::count_if(lines.begin(), lines.end(), [&](const std::string &p_line) {
			return p_line.find(p_part) != std::string::npos;
		}));
	}
};

} // namespace

TEST_CASE("[GPU][EdgeCount] lists with wrong counts or entries cost an image and one warning, not "
		  "the device") {
	const ReplacedTechnique<DamagedEdgeCount> technique;
	for (const LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		for (const auto &[next_damage, what] : { std::pair(Damage::NONE, ""),
					 std::pair(Damage::COUNTS_BEYOND, "a list of faces or edges"),
					 std::pair(Damage::ENTRIES_BEYOND, "a list of faces or edges") }) {
			CAPTURE(int(type));
			CAPTURE(int(next_damage));
			damage = next_damage;
			SmallScene scene(type);
			add_globe(scene);
			scene.light->name = "Lamp";
			MaskFixture fixture;
			DamagedEdgeCount::device = fixture.device.get();
			const CaughtFaults faults;
			for (int frame = 0; frame < 3; ++frame) {
				render_frame(fixture, scene, { .size_px = glm::uvec2(64), .may_reuse = false });
			}
			if (next_damage == Damage::NONE) {
				CHECK(faults.lines.empty());
				continue;
			}
			CHECK(faults.count(what) > 0);
			CHECK(faults.count("Light \"Lamp\", edge_count, pass \"resolve") +
							faults.count("Light \"Lamp\", edge_count, pass \"count solids") ==
					faults.lines.size());
			// Each pass reports a kind of fault once, not in each frame.
			const std::set<std::string> different(faults.lines.begin(), faults.lines.end());
			CHECK(different.size() == faults.lines.size());
		}
	}
}

TEST_CASE("[EdgeCount] each fault of each pass has a line that names light, pass and next step") {
	CHECK(describe_count_faults(0, "Sun").empty());
	const auto lines = describe_count_faults(EDGE_COUNT_FAULT_LOOP << EDGE_COUNT_LEAVES_LISTED |
					EDGE_COUNT_FAULT_LIST << EDGE_COUNT_LEAVES_SMOOTH |
					EDGE_COUNT_FAULT_TREE << EDGE_COUNT_PASS_LIST_LEAVES,
			"Sun");
	REQUIRE(lines.size() == 3);
	CHECK(lines[0].find("Light \"Sun\", edge_count, pass \"resolve\": the driver ended a loop") ==
			0);
	CHECK(lines[1].find("pass \"list leaves\": a walk through a tree") != std::string::npos);
	CHECK(lines[2].find("pass \"resolve smooth\": a list of faces or edges") != std::string::npos);
	CHECK(describe_count_faults(~0u, "Sun").size() == 21); // 3 kinds, 7 passes
}
