// Must be stopped by the address sanitizer; see test_canaries.py.
#include <vector>

int main(int p_argument_count, char **) {
	std::vector<int> values(4, p_argument_count);
	volatile int index = 4;				  // volatile: the compiler must not see the error
	return values.data()[index] == 12345; // any number: the value must be used
}
