"""What each figure shows, one file a figure: functions of results that describe drawings."""
