#pragma once

// Nothing to register: the module has only pure functions that techniques call.
