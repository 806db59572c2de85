// Must be reported by the thread sanitizer; see test_canaries.py.
#include <thread>

int shared_count = 0;

int main() {
	const auto count_up = [] {
		for (int i = 0; i < 100000; ++i) {
			shared_count = shared_count + 1;
		}
	};
	std::thread other(count_up);
	count_up();
	other.join();
	return shared_count == 12345; // any number: the value must be used
}
