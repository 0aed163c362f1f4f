"""What each figure of a plan shows, one file per figure: functions of a written plan and an area.

Each describes a drawing, or none where there is nothing to draw.
"""
