#pragma once

// Nothing to register: a device is made by whoever needs one, never by loading the module.
