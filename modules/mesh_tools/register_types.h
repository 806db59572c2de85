#pragma once

// Nothing to register: pure functions that techniques call.
