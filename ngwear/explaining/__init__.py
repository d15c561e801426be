"""The parts of ``ngwear explain`` for wear scenes: what effects bring, one mounting for pressures, verdicts, text."""
