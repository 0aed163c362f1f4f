"""What each figure shows, one file per figure: functions of results that describe drawings."""
