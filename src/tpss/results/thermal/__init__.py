"""Whether equipment gets too hot: a judgement of a run that has ended, which changes nothing in it."""
