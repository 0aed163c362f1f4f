"""How a run ended, in words."""

STATUS_IN_WORDS = {
    "finished": "The run finished.",
    "collapsed": "The line cannot carry its load: the run collapsed.",
    "stalled": "A train stalled, which ended the run.",
    "deadlocked": "Trains wait for each other, which ended the run.",
    "interrupted": "The run was interrupted.",
}
