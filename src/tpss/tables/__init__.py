"""Tables of numbers and names as offices have them: CSV of any kind, and workbooks of Excel."""
