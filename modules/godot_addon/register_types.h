#pragma once

// Nothing to register: Godot calls the add-on's entry point.
