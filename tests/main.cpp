#include "tests/test_runner.h"

// The program gnomon_tests.
int main(int p_argument_count, char **p_arguments) {
	return run_tests(p_argument_count, p_arguments);
}
