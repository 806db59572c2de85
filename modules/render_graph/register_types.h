#pragma once

// Nothing to register: the renderer creates its graphs directly.
