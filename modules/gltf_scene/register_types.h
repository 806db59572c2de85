#pragma once

// The module registers no types: load_gltf and save_gltf have no state.
