#pragma once

// Nothing to register: callers create the device, on top of one of Godot's.
