"""Key figures by the definitions of the standards, as functions of a result's dataset."""
