#ifndef LIT_TILES_SHARED_H
#define LIT_TILES_SHARED_H
#include "shared/shared_begin.h"

#define LIT_TILE_PX 16	 // width and height of a tile
#define LIT_TILE_BLOCKS 4 // blocks of 8 x 8 pixels of a tile

// Words of the buffer of tiles: their number, then the index of each, row by row from the top left.
#define LIT_TILES_COUNT 0
#define LIT_TILES_FIRST 1

// Words of the arguments of indirect dispatches: one work group for each block of a tile, and one
// for each tile. Rows have a fixed number of work groups, because the number of tiles may exceed
// the largest number of a dimension. The last row may have work groups without a tile.
#define LIT_TILES_BLOCK_ARGUMENTS 0
#define LIT_TILES_TILE_ARGUMENTS 4
#define LIT_TILES_ARGUMENT_WORDS 8
#define LIT_TILES_PER_ROW 64

// Bindings of tile_depths.comp and lit_tiles.comp.
#define LIT_TILES_BINDING_FRAME 0
#define LIT_TILES_BINDING_LIGHT 1
#define LIT_TILES_BINDING_DEPTH 2
#define LIT_TILES_BINDING_TILE_DEPTHS 3
#define LIT_TILES_BINDING_TILES 4
#define LIT_TILES_BINDING_ARGUMENTS 5
#define LIT_TILES_GROUP_SIZE 64

/// Push constants of lit_tiles.comp.
struct SHARED_ALIGN LitTilesPush {
	uint lists_all; // 1: tiles without a receiver are listed too
	uint padding1;
	uint padding2;
	uint padding3;
};
SHARED_SIZE(LitTilesPush, 16);

#include "shared/shared_end.h"
#endif
