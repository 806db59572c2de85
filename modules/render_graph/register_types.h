#pragma once

// Nothing to register: the renderer makes its graphs itself.
