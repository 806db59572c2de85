#pragma once

// Nothing to register: whoever shows something makes its window.
