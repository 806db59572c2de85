#pragma once

// Nothing to register: the add-on makes a device for the engine that hosts it.
