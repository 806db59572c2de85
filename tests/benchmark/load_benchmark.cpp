// Measures the time to load a scene file and to build the adjacency of its meshes, and prints it as
// JSON. Built by `scons benchmarks`, run by run_benchmarks.py.
//
//     gnomon_benchmark SCENE.gltf [RUNS]

#include "modules/core/error.h"
#include "modules/gltf_scene/gltf_scene.h"
#include "modules/mesh_tools/topology.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <set>

using namespace gnomon;

namespace {

constexpr int DEFAULT_RUN_COUNT = 10;

double get_seconds() {
	return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
			.count();
}

double compute_median(std::vector<double> p_values) {
	std::sort(p_values.begin(), p_values.end());
	const size_t middle = p_values.size() / 2;
	return p_values.size() % 2 == 1 ? p_values[middle]
									: 0.5 * (p_values[middle - 1] + p_values[middle]);
}

void run(const std::string &p_path, int p_run_count) {
	std::vector<double> load_s;
	std::vector<double> topology_s;
	std::vector<double> total_s;
	uint64_t triangle_count = 0;
	uint64_t edge_count = 0;
	for (int index = 0; index < p_run_count; ++index) {
		triangle_count = 0;
		edge_count = 0;
		const double start_s = get_seconds();
		const std::unique_ptr<Scene> scene = load_gltf(p_path);
		const double loaded_s = get_seconds();
		for (const MeshInstance3D *instance : scene->find_nodes<MeshInstance3D>()) {
			for (const MeshInstance3D::Surface &surface : instance->surfaces) {
				triangle_count += surface.mesh->get_triangle_count();
				edge_count +=
						get_topology(surface.mesh)->edges.size(); // builds it: the mesh is new
			}
		}
		const double end_s = get_seconds();
		load_s.push_back(loaded_s - start_s);
		topology_s.push_back(end_s - loaded_s);
		total_s.push_back(end_s - start_s);
	}
	const nlohmann::ordered_json json = { { "runs", p_run_count }, { "triangles", triangle_count },
		{ "edges", edge_count }, { "load_s", compute_median(load_s) },
		{ "topology_s", compute_median(topology_s) }, { "total_s", compute_median(total_s) } };
	std::printf("%s\n", json.dump(2).c_str());
}

} // namespace

int main(int p_argument_count, char **p_arguments) {
	const int run_count = p_argument_count > 2 ? std::atoi(p_arguments[2]) : DEFAULT_RUN_COUNT;
	if (p_argument_count < 2 || p_argument_count > 3 || run_count < 1) {
		std::fprintf(stderr,
				"Usage: gnomon_benchmark SCENE.gltf [RUNS]   runs: 1 or more, default %d\n",
				DEFAULT_RUN_COUNT);
		return 2;
	}
	try {
		run(p_arguments[1], run_count);
	} catch (const Error &error) {
		std::fprintf(stderr, "ERROR: %s\n", error.what());
		return 1;
	}
	return 0;
}
