// The test runner. Ends with one line "N passed, N failed, N skipped" (test cases) and exits 1 when
// any failed. A validation message during a test case fails that case, whatever it checked.

#include "modules/core/log.h"
#include "modules/core/module_registry.h"
#include "modules/rendering_device/rendering_device.h"

#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdio>
#include <set>
#include <string>

namespace {

std::set<std::string> cases_with_messages;
unsigned case_count = 0;
unsigned failed_count = 0;

/// Compares the count of validation messages before and after each test case.
struct ValidationListener : doctest::IReporter {
	const doctest::TestCaseData *current = nullptr;
	unsigned messages_before = 0;

	explicit ValidationListener(const doctest::ContextOptions &) {}
	void report_query(const doctest::QueryData &) override {}
	void test_run_start() override {}
	void test_run_end(const doctest::TestRunStats &) override {}
	void test_case_start(const doctest::TestCaseData &p_case) override {
		current = &p_case;
		messages_before = gnomon::RenderingDevice::get_validation_message_count();
	}
	void test_case_reenter(const doctest::TestCaseData &) override {}
	void test_case_end(const doctest::CurrentTestCaseStats &p_stats) override {
		const unsigned messages = gnomon::RenderingDevice::get_validation_message_count();
		const bool has_messages = messages != messages_before;
		++case_count;
		if (has_messages) {
			cases_with_messages.insert(current->m_name);
		}
		if (has_messages || !p_stats.testCaseSuccess) {
			++failed_count;
		}
	}
	void test_case_exception(const doctest::TestCaseException &) override {}
	void subcase_start(const doctest::SubcaseSignature &) override {}
	void subcase_end() override {}
	void log_assert(const doctest::AssertData &) override {}
	void log_message(const doctest::MessageData &) override {}
	void test_case_skipped(const doctest::TestCaseData &) override {}
};
REGISTER_LISTENER("validation", 1, ValidationListener);

} // namespace

int main(int p_argument_count, char **p_arguments) {
	gnomon::register_modules();
	gnomon::ModuleRegistry::initialize(gnomon::ModuleLevel::FEATURES);

	doctest::Context context;
	context.setOption("no-version", true);
	context.applyCommandLine(p_argument_count, p_arguments);
	const int result = context.run();
	gnomon::ModuleRegistry::uninitialize();
	if (context.shouldExit()) {
		return result;
	}
	for (const std::string &name : cases_with_messages) {
		std::fprintf(stderr, "FAILED: validation messages during \"%s\"\n", name.c_str());
	}
	std::printf("%u passed, %u failed, 0 skipped\n", case_count - failed_count, failed_count);
	return failed_count == 0 && result == 0 ? 0 : 1;
}
