#pragma once

// This module registers nothing: users create a ShaderWatcher themselves.
