#pragma once

// Nothing to register: callers create the device; loading the module does not.
