function text = tabletop_text(bytes)
% TABLETOP_TEXT  UTF-8 as text of this engine.  In Octave a text is its bytes.
if any(bytes > 127) && ~exist('OCTAVE_VERSION', 'builtin')
    text = native2unicode(bytes, 'UTF-8');
else
    text = char(bytes);
end
end
