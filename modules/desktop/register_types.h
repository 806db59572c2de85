#pragma once

// Nothing to register: callers create the window.
