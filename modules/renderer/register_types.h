#pragma once

// The build requires this file in every module. Nothing to register: techniques and filters come
// from their own modules.
