// Must be stopped by the undefined behaviour sanitizer; see test_canaries.py.
#include <limits>

int main() {
	volatile int value = std::numeric_limits<int>::max();
	value = value + 1;
	return value == 12345; // any number: the value must be used
}
