#pragma once

// Nothing to register: load_gltf and save_gltf keep no state.
