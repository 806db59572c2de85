#include "modules/main/commands.h"

int main(int p_argument_count, char **p_arguments) {
	return gnomon::run_gnomon(p_argument_count, p_arguments);
}
