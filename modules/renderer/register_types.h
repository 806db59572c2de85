#pragma once

// Nothing to register: techniques and filters come from the modules that hold them.
