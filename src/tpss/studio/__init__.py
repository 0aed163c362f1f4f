"""The studio: a scenario in the browser, edited by hand while its results follow.

A page that is served from this computer only (`serve`) sends its edits, and gets what comes of them: the
scenario's document, its findings, and drawings of a run (`answer`).  The server keeps no edits, but a
draft of them on the disk (`drafts`): what a page asks for is told whole in each request.
"""
