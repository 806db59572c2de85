class_name FrameTimes
extends RefCounted
## Measures how long frames take.

const WARM_UP_FRAMES := 10


## Returns the median time of `count` frames in milliseconds, after WARM_UP_FRAMES. `move` is called with the frame's number
## before each frame.
static func measure(count: int, move: Callable) -> float:
	var samples: Array[float] = []
	var before := 0
	for frame in WARM_UP_FRAMES + count + 1:
		move.call(frame)
		await RenderingServer.frame_post_draw
		var now := Time.get_ticks_usec()
		if frame > WARM_UP_FRAMES:
			samples.append((now - before) / 1000.0)
		before = now
	samples.sort()
	return samples[samples.size() / 2]
