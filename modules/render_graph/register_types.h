#pragma once

// Nothing to register: callers create graphs directly.
