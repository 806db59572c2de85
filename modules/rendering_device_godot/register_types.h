#pragma once

// Nothing to register: the add-on creates a device for the engine that hosts it.
