// fuzz: modules=core
// Parses arbitrary text as a project.cfg. Replacing the list of disabled modules must change
// nothing else. The folder does not exist, so all scenes are among the missing ones.
#include "modules/core/project.h"

#include "tests/fuzz/fuzz_target.h"

using namespace gnomon;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *p_data, size_t p_size) {
	return run_reader([&] {
		const std::filesystem::path path = "/nonexistent/project.cfg";
		const std::string before(to_text(p_data, p_size));
		const Project project = Project::parse(before, path);
		for (const std::vector<std::string> &names :
				{ std::vector<std::string>{}, { "one" }, { "one", "two" } }) {
			const std::string after = Project::replace_disabled_modules(before, names, path);
			const Project again = Project::parse(after, path);
			GNOMON_ASSERT(again.disabled_modules == names, "another list was read back: ", after);
			GNOMON_ASSERT(again.name == project.name && again.defaults == project.defaults &&
							again.start_scene == project.start_scene &&
							again.technique_settings == project.technique_settings &&
							again.missing_scenes == project.missing_scenes,
					"replacing the list changed other values: ", after);
		}
	});
}
